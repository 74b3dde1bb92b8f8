// `karst completion bash|zsh`, and `karst man DIR`, which writes the manual pages: both from the tree of
// commands.
#pragma once

namespace CLI {
class App;
}

namespace karst::tools {

/// The commands know all of `app` when they are called, also what is added to it later.
void add_help_commands(CLI::App& app);

}  // namespace karst::tools
