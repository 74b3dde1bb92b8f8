// `karst policy`: the policies this installation can fly, and new ones.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

/// Adds `policy list [--json] [--verbose] [--plugin FILE...]` and `policy new` to the application.
void add_policy_command(CLI::App& app);

}  // namespace karst::tools
