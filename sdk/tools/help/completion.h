// Scripts with which a shell completes the command line of `karst`.
#pragma once
#include <string>
#include <vector>

#include "sdk/tools/help/command_tree.h"

namespace karst::tools {

/// To be read by bash: commands, options, policies as `karst policy list` has them, files and folders.
std::string bash_completion(const std::vector<Command>& commands);

/// The same for zsh, as the file _karst in a folder of its fpath.
std::string zsh_completion(const std::vector<Command>& commands);

}  // namespace karst::tools
