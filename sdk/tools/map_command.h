// `karst map merge`: merges the maps of several flights.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

void add_map_command(CLI::App& app);

}  // namespace karst::tools
