// `karst select`: the policy for a cave.
#pragma once
#include <string>

namespace CLI {
class App;
}

namespace karst::tools {

/// The experience that comes with this installation; "" if it has none.
std::string installed_experience();

/// Adds `select` to the application.
void add_select_command(CLI::App& app);

}  // namespace karst::tools
