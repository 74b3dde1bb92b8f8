#include "sdk/tools/cave_files.h"

#include <algorithm>
#include <filesystem>

#include "core_stack/common/error.h"
#include "core_stack/common/printable.h"

namespace karst::tools {

CaveFiles new_cave_files(const std::string& out, const std::string& mesh_format, bool force) {
  namespace fs = std::filesystem;
  using core::InputError;
  const fs::path stem(out);
  if (stem.filename().empty())
    throw InputError("--out", out, "expected a file name without ending, such as caves/demo");
  if (std::error_code failed;
      stem.has_parent_path() && (fs::create_directories(stem.parent_path(), failed), failed))
    throw InputError(stem.parent_path().string(), "", "cannot be made: " + failed.message());
  const CaveFiles files{out + "." + mesh_format, out + ".info", stem.filename().string() + "." + mesh_format};
  for (const std::string& path : {files.mesh, files.info})
    if (fs::exists(path) && !force)
      throw InputError(path, "", "is there already; choose another --out, or give --force to overwrite it");
  return files;
}

std::string comment_line(const std::string& text) {
  std::string line = core::printable(text);
  std::replace(line.begin(), line.end(), '\n', ' ');
  return "; " + line + "\n";
}

}  // namespace karst::tools
