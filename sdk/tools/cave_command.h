// `karst cave generate` and `karst cave info`.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

/// Adds both to the application. Errors leave `parse` as exceptions that name file, place and reason.
void add_cave_command(CLI::App& app);

}  // namespace karst::tools
