// `karst cave`: generate, from-cloud, info and describe.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

/// Adds them to the application. `parse` throws errors as exceptions with file, place and reason.
void add_cave_command(CLI::App& app);

}  // namespace karst::tools
