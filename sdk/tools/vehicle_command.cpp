#include "sdk/tools/vehicle_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <thread>

#include "core_stack/common/error.h"
#include "core_stack/common/install_location.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/arguments.h"
#include "sdk/tools/interrupt.h"
#include "sdk/tools/mesh_options.h"
#include "sdk/vehicle_server/conformance.h"
#include "sdk/vehicle_server/serve_missions.h"

namespace karst::tools {
namespace {

namespace fs = std::filesystem;
constexpr int kDoesNotConform = 2;

struct ServeArguments {
  std::string mission_file, listen = "tcp:127.0.0.1:14660", truth;
  flight::MissionOverrides overrides;
  MeshOptions mesh;
  int threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  bool once = false;
};

void serve(const ServeArguments& args) {
  if (args.mission_file.empty() && args.overrides.cave.empty())
    throw core::InputError("karst vehicle serve", "", "needs a MISSION file or --cave FILE");
  flight::MissionOverrides overrides = args.overrides;
  for (const auto& [key, value] : args.mesh) overrides.values.emplace_back("cave." + key, value);
  const flight::Mission mission = flight::read_mission(args.mission_file, overrides);
  vehicle_server::ServeRequest request;
  request.address = socket::parse_address(args.listen);
  request.truth = args.truth;
  request.threads = args.threads;
  request.once = args.once;
  vehicle_server::ServeNotes notes;
  notes.listening = [](const std::string& address) {
    print_out("listening at %s\n", address.c_str());
    std::fflush(stdout);
  };
  notes.mission_over = [](const std::string& ending, const fs::path& truth) {
    print_out("mission over: %s\n", ending.c_str());
    if (!truth.empty()) print_out("  %s   ground truth, for karst evaluate RUN --truth\n", truth.c_str());
    std::fflush(stdout);
  };
  notes.not_flown = [](const std::string& why) {
    print_out("not flown: %s\n", why.c_str());
    std::fflush(stdout);
  };
  vehicle_server::serve_missions(mission, request, notes, watch_for_interrupt());
}

void add_serve(CLI::App& vehicle) {
  auto args = std::make_shared<ServeArguments>();
  CLI::App* app = vehicle.add_subcommand(
      "serve",
      "Put the vehicle of a mission behind a socket, for a karst in another process\n\n"
      "  karst vehicle serve mission.info --listen unix:/tmp/vehicle --truth truth --once\n"
      "  karst fly mission.info --set vehicle=socket --set socket.address=unix:/tmp/vehicle --out run\n"
      "  karst evaluate run --truth truth/1\n\n"
      "Serves one mission after another until Ctrl-C. The seed is the client's. The protocol: " +
          core::doc_path("docs/vehicle_protocol.md"));
  app->add_option("mission", args->mission_file, "mission file (.info)")
      ->type_name(kFile)
      ->check(not_empty());
  app->add_option("--cave", args->overrides.cave, "cave .info file or mesh (STL, PLY, OBJ, DAE)")
      ->type_name(kFile)
      ->check(not_empty());
  app->add_option("--start", args->overrides.start, "\"x y z [heading_deg]\" above the floor to start from")
      ->check(not_empty());
  add_mesh_options(*app, args->mesh);
  app->add_option("--set", args->overrides.settings, "key=value; see karst fly --keys")
      ->type_name(kSetting)
      ->allow_extra_args(false);
  app->add_option("--listen", args->listen, "tcp:HOST:PORT, tcp:PORT (127.0.0.1; 0 chooses one) or unix:PATH")
      ->capture_default_str()
      ->check(not_empty());
  app->add_option("--truth", args->truth, "folder for ground truth: 1, 2, ... in it for each mission")
      ->type_name(kFolder)
      ->check(not_empty());
  app->add_option("--threads", args->threads, "as of karst fly")->check(CLI::Range(1, 256));
  app->add_flag("--once", args->once, "end after the first mission");
  app->callback([args] { serve(*args); });
}

void add_check(CLI::App& vehicle) {
  struct Arguments {
    std::string address;
    vehicle_server::ConformanceOptions options;
  };
  auto args = std::make_shared<Arguments>();
  CLI::App* app = vehicle.add_subcommand(
      "check",
      "Check that a vehicle behind a socket keeps the protocol\n\n"
      "  karst vehicle check tcp:127.0.0.1:14660 --fly\n\n"
      "Exit code: 0 it does, as far as this can tell; 2 it does not; 1 nothing answers there.");
  app->add_option("address", args->address, "tcp:HOST:PORT, tcp:PORT or unix:PATH")
      ->required()
      ->check(not_empty());
  app->add_flag(
      "--fly", args->options.takes_off,
      "arm it, lift off by a few decimetres, and give no more commands: not with a real vehicle indoors");
  app->add_option("--seconds", args->options.seconds, "to watch it, in lockstep and in real time")
      ->capture_default_str()
      ->check(number_in(1.0, 600.0));
  app->callback([args] {
    watch_for_interrupt();  // a closed connection must not end the process
    bool conforms = true;
    vehicle_server::check_vehicle(
        socket::parse_address(args->address), args->options, [&conforms](const vehicle_server::Finding& f) {
          using enum vehicle_server::Verdict;
          const char* verdict = f.verdict == passed ? "ok  " : f.verdict == failed ? "FAIL" : "skip";
          print_out("%s  %s: %s\n", verdict, f.name.c_str(), f.detail.c_str());
          std::fflush(stdout);
          conforms = conforms && f.verdict != failed;
        });
    print_out("%s\n", conforms ? "the vehicle conforms" : "the vehicle does not conform");
    if (!conforms) throw CLI::RuntimeError(kDoesNotConform);
  });
}

}  // namespace

void add_vehicle_command(CLI::App& app) {
  CLI::App* vehicle = app.add_subcommand("vehicle", "Vehicles in other processes: serve one, check one");
  vehicle->require_subcommand(1);
  add_serve(*vehicle);
  add_check(*vehicle);
}

}  // namespace karst::tools
