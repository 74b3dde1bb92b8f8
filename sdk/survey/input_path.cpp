#include "sdk/survey/input_path.h"

#include <algorithm>
#include <system_error>
#include <vector>

#include "sdk/survey/lower_case.h"

namespace karst::survey {
namespace {

namespace fs = std::filesystem;

/// What a folder calls `name` in any case; empty if nothing.
fs::path entry_of(const fs::path& folder, const std::string& name) {
  std::vector<std::string> fitting;
  std::error_code failed;
  for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed))
    if (lower_case(it->path().filename().string()) == lower_case(name))
      fitting.push_back(it->path().filename().string());
  return fitting.empty() ? fs::path() : fs::path(*std::min_element(fitting.begin(), fitting.end()));
}

fs::path in_any_case(const fs::path& folder, const fs::path& name) {
  fs::path path = name.is_absolute() ? fs::path("/") : folder.empty() ? fs::path(".") : folder;
  std::error_code none;
  for (const fs::path& part : name.relative_path()) {
    if (part == ".." || part == "." || fs::exists(path / part, none)) {
      path /= part;
      continue;
    }
    const fs::path entry = entry_of(path, part.string());
    if (entry.empty()) return {};
    path /= entry;
  }
  return path;
}

}  // namespace

InputPath input_path(const fs::path& folder, const std::string& name) {
  std::string slashes = name;
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  std::error_code none;
  const auto is_file = [&](const fs::path& p) { return fs::exists(p, none) && !fs::is_directory(p, none); };
  for (const char* ending : {"", ".th", ".th2"})
    if (const fs::path path = folder / (slashes + ending); is_file(path)) return {path, false};
  for (const char* ending : {"", ".th", ".th2"})
    if (const fs::path path = in_any_case(folder, slashes + ending); is_file(path)) return {path, true};
  return {};
}

}  // namespace karst::survey
