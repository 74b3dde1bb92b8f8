// `karst policy new NAME`: creates a folder with a policy to start from.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

/// Adds `new NAME [--dir D] [--template nearest|tour|memory|c]` to the command `policy`.
void add_policy_new(CLI::App& policy);

}  // namespace karst::tools
