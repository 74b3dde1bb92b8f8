// `karst vehicle`: puts a simulated vehicle behind a socket, and checks vehicles of others.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

void add_vehicle_command(CLI::App& app);

}  // namespace karst::tools
