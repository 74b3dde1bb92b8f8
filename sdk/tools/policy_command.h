// `karst policy`: lists the policies of this installation and works with single ones.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

/// Adds `policy` with `new` and `list`, and returns it for others that work with policies.
CLI::App& add_policy_command(CLI::App& app);

}  // namespace karst::tools
