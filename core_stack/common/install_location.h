// Where this installation keeps what it loads and what its texts name: relative to the executable, in the
// build tree as when installed.
#pragma once
#include <filesystem>
#include <string>
#include <system_error>

namespace karst::core {

/// The folder that holds bin, lib and share.
inline std::filesystem::path install_root() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path().parent_path();
}

inline std::filesystem::path plugin_root() { return install_root() / "lib" / "karst"; }

/// The folder that holds docs and examples.
inline std::filesystem::path doc_root() { return install_root() / "share" / "doc" / "karst"; }

/// The path of a page or an example, such as "docs/select.md"; if it is not installed, where else it is.
inline std::string doc_path(const std::string& name) {
  const std::filesystem::path file = doc_root() / name;
  std::error_code error;
  return std::filesystem::exists(file, error) ? file.string() : name + " of karst's sources";
}

}  // namespace karst::core
