#include "sdk/tools/live_flight_option.h"

#include <unistd.h>

#include <chrono>
#include <filesystem>

#include "sdk/flight/flight_setup.h"
#include "sdk/live/live_flight.h"
#include "sdk/terminal/terminal.h"

namespace karst::tools {
namespace {

/// Another for each flight, so that clients know when a server is a new one.
std::string session_name() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::to_string(std::chrono::duration_cast<std::chrono::milliseconds>(now).count()) + "-" +
         std::to_string(getpid());
}

}  // namespace

std::shared_ptr<core::RecordListener> serve_live(const flight::Mission& mission,
                                                 const flight::FlightRequest& request,
                                                 const LiveArguments& args) {
  live::LiveSetup setup;
  setup.endpoint = live::endpoint_of(args.address, "--live");
  setup.token = args.token;
  setup.name = "karst " KARST_VERSION;
  setup.session = session_name();
  setup.metadata = {{"policy", mission.policy},
                    {"vehicle", mission.vehicle},
                    {"cave", std::filesystem::path(mission.cave).filename().string()},
                    {"seed", std::to_string(mission.seed)}};
  if (request.notes) setup.log = [](const std::string& text) { print_error("live: %s\n", text.c_str()); };
  const auto live = std::make_shared<live::LiveFlight>(std::move(setup), mission.core.map.resolution_m,
                                                       request.run_dir / "map.bt");
  if (request.notes)
    print_error("live: follow the flight at http://%s/%s\n", live::text_of(live->endpoint()).c_str(),
                args.token.empty() ? "" : "?token=...");
  return {live, &live->listener()};
}

}  // namespace karst::tools
