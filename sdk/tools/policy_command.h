// `karst policy list`: the policies this installation can fly.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

/// Adds `policy list [--json] [--verbose] [--plugin FILE...]` to the application.
void add_policy_command(CLI::App& app);

}  // namespace karst::tools
