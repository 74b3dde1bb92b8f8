// `karst cave generate` and `karst cave info`.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

/// Adds them to the application, and returns `cave` for others that tell of caves. `parse` throws errors as
/// exceptions with file, place and reason.
CLI::App& add_cave_command(CLI::App& app);

}  // namespace karst::tools
