#include "core_stack/common/program_in_path.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <system_error>

namespace karst::core {
namespace {

bool is_program(const std::filesystem::path& file) {
  std::error_code none;
  return std::filesystem::is_regular_file(file, none) &&
         faccessat(AT_FDCWD, file.c_str(), X_OK, AT_EACCESS) == 0;
}

}  // namespace

std::optional<std::string> program_in_path(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::filesystem::path file = std::filesystem::path(folder) / name;
    if (!folder.empty() && is_program(file)) return file.string();
  }
  return std::nullopt;
}

}  // namespace karst::core
