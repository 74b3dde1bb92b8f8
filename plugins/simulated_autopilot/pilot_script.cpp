#include "plugins/simulated_autopilot/pilot_script.h"

#include <cmath>
#include <sstream>

#include "core_stack/common/error.h"

namespace karst::sim {

std::vector<PilotStep> read_pilot_script(const std::string& text) {
  std::vector<PilotStep> script;
  std::istringstream all(text);
  for (std::string one; std::getline(all, one, ',');) {
    const auto refuse = [&one](const std::string& why) {
      throw core::InputError("simulated_autopilot.pilot", "\"" + one + "\"", why);
    };
    std::istringstream words(one);
    double at_s = 0;
    std::string action, more;
    if (!(words >> at_s >> action) || words >> more || !(at_s >= 0 && at_s < 1e6))
      refuse("expected seconds and an action, such as \"2 arm\"");
    const auto known = core::parse<PilotAction>(action);
    if (!known) {
      std::string names;
      for (const std::string& name : core::all_names<PilotAction>()) names += " " + name;
      refuse("no action of a pilot; there is:" + names);
    }
    const core::TimeNs at = core::from_seconds(at_s);
    if (!script.empty() && at < script.back().at) refuse("comes before the step ahead of it");
    script.push_back({at, *known});
  }
  return script;
}

}  // namespace karst::sim
