// `karst policy`: the policies this installation can fly, and what can be done with one.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

/// Adds `policy` with its subcommands to the application.
void add_policy_command(CLI::App& app);

}  // namespace karst::tools
