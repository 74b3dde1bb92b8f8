// Manual pages of `karst` and of each of its commands, for man(1).
#pragma once
#include <map>
#include <string>
#include <vector>

#include "sdk/tools/help/command_tree.h"

namespace karst::tools {

/// Where documentation lies for the karst that writes the pages, and for who reads them.
struct DocFolders {
  std::string here, of_reader;
};

/// Pages in roff by the name of their file: "karst-policy-new.1".
std::map<std::string, std::string> man_pages(const std::vector<Command>& commands, const std::string& version,
                                             const DocFolders& doc);

}  // namespace karst::tools
