// `karst policy check`: does a policy hold what a flight, and its users, need of it?
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

/// Adds `check`, and the hidden commands that its children run, to `karst policy`.
void add_check_command(CLI::App& policy);

}  // namespace karst::tools
