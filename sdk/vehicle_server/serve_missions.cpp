#include "sdk/vehicle_server/serve_missions.h"

#include "core_stack/common/error.h"
#include "core_stack/common/printable.h"
#include "plugins/socket/vehicle_server.h"
#include "sdk/flight/flight_setup.h"

namespace karst::vehicle_server {
namespace {

namespace fs = std::filesystem;

/// The first folder 1, 2, ... in `truth` that is not there yet.
fs::path next_folder(const fs::path& truth) {
  for (int i = 1;; ++i)
    if (const fs::path folder = truth / std::to_string(i); !fs::exists(folder)) return folder;
}

/// Ground truth goes where this mission's mission.info is: `karst evaluate --truth` reads both.
void make_folder(const fs::path& folder, const flight::Mission& mission) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw core::InputError(folder.string(), "", "the folder cannot be made: " + error.message());
  flight::write_mission(folder / "mission.info", flight::recorded_mission(mission, {}, ""));
}

}  // namespace

void serve_missions(const flight::Mission& mission, const ServeRequest& request, const ServeNotes& notes,
                    const std::atomic<bool>& interrupted) {
  if (flight::is_team(mission))
    throw core::InputError(mission.file, "team.robots", "a vehicle behind a socket is a single one");
  flight::make_vehicles(mission, {mission}, "");  // a bad cave or start is the server's fault, not a client's
  socket::Listener listener(request.address);
  notes.listening(listener.address().text());
  while (!interrupted) {
    std::optional<socket::Stream> client = listener.accept(socket::Wait(100));
    if (!client) continue;
    const socket::Doorkeeper doorkeeper(listener);
    const fs::path folder = request.truth.empty() ? "" : next_folder(request.truth);
    bool made = false;
    const auto make = [&](const socket::Hello& hello) {
      flight::Mission flown = mission;
      flown.seed = static_cast<std::int64_t>(hello.seed);
      flown.resolved.put("seed", flown.seed);
      flown.core.mission.takeoff_height_m = hello.climb_m;
      if (!folder.empty()) make_folder(folder, flown);
      made = !folder.empty();
      return flown.vehicle_plugin->create(flight::vehicle_setup(flown, folder));
    };
    socket::ServeOptions options;
    options.threads = request.threads;
    const socket::Served served = socket::serve_client(*client, make, options, interrupted);
    const std::string ending = core::printable(served.ending);
    if (served.flew) {
      notes.mission_over(ending, folder);
      if (request.once) return;
    } else {
      std::error_code ignored;
      if (made) fs::remove_all(folder, ignored);
      notes.not_flown(ending);
    }
  }
}

}  // namespace karst::vehicle_server
