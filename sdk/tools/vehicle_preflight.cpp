#include "sdk/tools/vehicle_preflight.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core_stack/common/error.h"
#include "core_stack/common/install_location.h"
#include "sdk/evaluation/record/whole_file.h"
#include "sdk/flight/auto_policy.h"
#include "sdk/flight/flight_setup.h"
#include "sdk/flight/known_map.h"
#include "sdk/flight/loaded_policies.h"
#include "sdk/preflight/vehicle/listen.h"
#include "sdk/preflight/vehicle/vehicle_page.h"
#include "sdk/preflight/vehicle/vehicle_words.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/interrupt.h"

namespace karst::tools {
namespace {

flight::FlightRequest request_of(const VehiclePreflightArguments& args) {
  flight::FlightRequest request;
  request.plugins = args.plugins;
  request.clock = args.real_time ? core::Clock::real_time : core::Clock::lockstep;
  request.notes = false;
  return request;
}

/// Why the mission's policy cannot be loaded; "" if it can.
std::string policy_problem(flight::Mission mission, const flight::FlightRequest& request) {
  try {
    if (mission.policy == flight::kAutoPolicy) flight::choose_policy(mission);
    flight::load_policies({mission}, request);
    return "";
  } catch (const core::InputError& e) {
    return e.what();
  }
}

/// Goes to standard error: a person must see it, whatever is done with the output.
void instruct(preflight::ListenStep step, const VehiclePreflightArguments& args) {
  if (step == preflight::ListenStep::rest)
    print_wrapped(
        stderr, 2,
        "Props off. The vehicle stands on its pad, and nobody touches it for %.0f s. It is not armed "
        "and not commanded.\n",
        args.rest_s);
  else
    print_wrapped(
        stderr, 2,
        "Now take it into your hands, and for %.0f s roll it, nod it and turn it, each several times "
        "by 30 deg and more, gently, within 5 m of walls. Keep hands and sleeves out of the LiDAR's "
        "view.\n",
        args.motion_s);
}

}  // namespace

bool is_vehicle(const std::string& name) {
  return !name.empty() && name.find('/') == std::string::npos &&
         std::filesystem::exists(core::plugin_root() / "vehicles" / ("libkarst_vehicle_" + name + ".so"));
}

bool vehicle_preflight(const VehiclePreflightArguments& args) {
  const flight::Mission mission =
      flight::with_earlier_map(flight::read_mission(args.mission_file, args.overrides));
  if (flight::is_team(mission))
    throw core::InputError(mission.file, "team.robots", "a preflight is for one vehicle, not for a team");
  const flight::FlightRequest request = request_of(args);
  preflight::MachineFacts machine = preflight::machine_facts(args.run_folder);
  machine.policy = mission.policy;
  machine.policy_problem = policy_problem(mission, request);

  const flight::Vehicles vehicles = flight::make_vehicles(mission, {mission}, "", request.clock);
  preflight::ListenOptions how;
  how.rest = core::from_seconds(args.rest_s);
  how.motion = args.motion ? core::from_seconds(args.motion_s) : 0;
  how.clock = request.clock;
  if (args.motion || !args.quiet) how.begins = [&args](preflight::ListenStep step) { instruct(step, args); };
  const std::atomic<bool>& interrupted = watch_for_interrupt();
  const preflight::VehicleRecord record = preflight::listen(*vehicles.alone, how, interrupted);
  if (interrupted)
    throw core::InputError(mission.vehicle, "", "the preflight was interrupted: it says nothing");

  preflight::VehicleMeasurements m =
      preflight::measure(record, {.climb_m = mission.core.mission.takeoff_height_m,
                                  .home_reserve_s = mission.core.mission.home_reserve_s,
                                  .loam = mission.core.localization.loam});
  m.plugin = mission.vehicle;
  m.mission_file = args.mission_file;
  m.clock = how.clock;
  m.machine = machine;
  if (mission.record.scans)
    m.machine.scans_bytes = preflight::scans_bytes_per_s(record) * mission.core.mission.max_flight_time_s;
  const std::vector<preflight::Check> checks = preflight::checks_of(m);
  if (!args.page.empty()) evaluation::write_whole_file(args.page, preflight::vehicle_page(m, checks));
  if (args.json) {
    print_json(preflight::to_json(m, checks));
  } else {
    constexpr std::size_t kColumnsOfAFile = 100;
    const std::size_t columns = terminal_columns(stdout);
    print_out("%s",
              wrapped(preflight::checks_text(m, checks), columns > 0 ? columns : kColumnsOfAFile, 4).c_str());
  }
  return preflight::verdict_of(checks) != preflight::Outcome::no_go;
}

}  // namespace karst::tools
