// `karst cave generate` and `karst cave info`.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

/// Adds both to the application. `parse` throws errors as exceptions with file, place and reason.
void add_cave_command(CLI::App& app);

}  // namespace karst::tools
