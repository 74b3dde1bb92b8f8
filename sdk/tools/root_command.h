// `karst` without its commands, and its entry: what the whole program and the one that only flies have in
// common.
#pragma once
#include <memory>

namespace CLI {
class App;
}

namespace karst::tools {

/// The name, the description and the version.
std::shared_ptr<CLI::App> root_command();

/// Adds `--help-all`. Call it last: commands inherit what is there when they are added, and need none of
/// their own.
void add_help_of_all(CLI::App& app);

/// What main() does with karst_command(): the exit code of the program.
int karst_main(int argc, char** argv);

}  // namespace karst::tools
