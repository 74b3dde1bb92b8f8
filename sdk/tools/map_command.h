// `karst map merge`: maps of several flights in one.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

void add_map_command(CLI::App& app);

}  // namespace karst::tools
