// `karst policy check`: tests whether a policy meets the requirements of flights and users.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

/// Adds `check`, and the hidden commands of its child processes, to `karst policy`.
void add_check_command(CLI::App& policy);

}  // namespace karst::tools
