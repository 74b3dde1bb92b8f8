// `karst fly`: one mission, from the mission file to the report.
#pragma once
#include <functional>
#include <memory>
#include <string>

namespace CLI {
class App;
}

namespace karst::core {
class RecordListener;
}

namespace karst::flight {
struct FlightRequest;
struct Mission;
}  // namespace karst::flight

namespace karst::tools {

/// Sets the policy of a mission that asks for `auto`, and leaves any other as it is: flight::choose_policy,
/// or what refuses in a program that lacks it.
using PolicyChooser = std::function<void(flight::Mission&)>;

/// What --live and --live-token say.
struct LiveArguments {
  bool asked = false;
  std::string address, token;
};
/// Serves the flight that it then listens to: serve_live (live_flight_option.h), or what refuses in a program
/// that lacks it.
using LiveStarter = std::function<std::shared_ptr<core::RecordListener>(
    const flight::Mission&, const flight::FlightRequest&, const LiveArguments&)>;

void add_fly_command(CLI::App& app, PolicyChooser choose_policy, LiveStarter start_live);

}  // namespace karst::tools
