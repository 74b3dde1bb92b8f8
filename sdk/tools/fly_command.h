// `karst fly`: one mission, from the mission file to the report.
#pragma once
#include <functional>

namespace CLI {
class App;
}

namespace karst::flight {
struct Mission;
}

namespace karst::tools {

/// Sets the policy of a mission that asks for `auto`, and leaves any other as it is: flight::choose_policy,
/// or what refuses in a program that lacks it.
using PolicyChooser = std::function<void(flight::Mission&)>;

void add_fly_command(CLI::App& app, PolicyChooser choose_policy);

}  // namespace karst::tools
