// karst recover: the map and the figures of a flight that was cut off.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

void add_recover_command(CLI::App& app);

}  // namespace karst::tools
