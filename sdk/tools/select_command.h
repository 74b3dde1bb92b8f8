// `karst select`: selects the policy for a cave.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

/// Adds `select` to the application.
void add_select_command(CLI::App& app);

}  // namespace karst::tools
