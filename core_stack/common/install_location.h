// Where this installation keeps its plugins: relative to the executable, in the build tree as when installed.
#pragma once
#include <filesystem>

namespace karst::core {

inline std::filesystem::path plugin_root() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path().parent_path() / "lib" / "karst";
}

}  // namespace karst::core
