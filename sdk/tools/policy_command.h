// `karst policy`: lists the policies of this installation and works with single ones.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

/// Adds `policy` with its subcommands to the application.
void add_policy_command(CLI::App& app);

}  // namespace karst::tools
