// Manual pages of `karst` and of each of its commands, for man(1).
#pragma once
#include <map>
#include <string>
#include <vector>

#include "sdk/tools/help/command_tree.h"

namespace karst::tools {

/// Pages in roff by the name of their file: "karst-policy-new.1". Paths below `doc_root` lose it: a page may
/// be installed anywhere.
std::map<std::string, std::string> man_pages(const std::vector<Command>& commands, const std::string& version,
                                             const std::string& doc_root);

}  // namespace karst::tools
