// `karst tune`: searches for better parameters of a policy.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

/// Adds `tune` to the application.
void add_tune_command(CLI::App& app);

}  // namespace karst::tools
