// Programs of others that karst calls by their names.
#pragma once
#include <optional>
#include <string>

namespace karst::core {

/// The first file of this name in the folders of PATH that may be executed. An empty entry, which a shell
/// takes for the current folder, is passed over: the data of others lie there.
std::optional<std::string> program_in_path(const std::string& name);

}  // namespace karst::core
