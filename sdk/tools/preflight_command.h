// `karst preflight`: go or no-go for a mission, before it is flown.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

/// Adds `preflight` to the application.
void add_preflight_command(CLI::App& app);

}  // namespace karst::tools
