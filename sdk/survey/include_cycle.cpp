#include "sdk/survey/include_cycle.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "core_stack/common/printable.h"
#include "sdk/survey/lower_case.h"

namespace karst::survey {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostSvxBytes = 1024 * core::kMiB;

/// NAME of a line `*include NAME`, which may be in quotes; empty if the line is another one.
std::string included_name(const std::string& line) {
  constexpr const char* kBlanks = " \t\r,";
  std::string_view rest = line;
  const auto skip_blanks = [&] {
    rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
  };
  skip_blanks();
  if (!rest.starts_with('*')) return "";
  rest.remove_prefix(1);
  skip_blanks();
  constexpr std::string_view kInclude = "include";
  if (lower_case(std::string(rest.substr(0, kInclude.size()))) != kInclude) return "";
  rest.remove_prefix(kInclude.size());
  if (rest.empty() || (rest.front() != '"' && std::string_view(kBlanks).find(rest.front()) == rest.npos))
    return "";
  skip_blanks();
  if (rest.starts_with('"')) {
    rest.remove_prefix(1);
    return std::string(rest.substr(0, rest.find('"')));
  }
  return std::string(rest.substr(0, rest.find_first_of(" \t\r;")));
}

/// Empty if there is none.
fs::path included_file(const fs::path& folder, const std::string& name) {
  std::string slashes = name;
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  std::error_code none;
  for (const std::string& spelt : {slashes, lower_case(slashes)})
    for (const char* ending : {"", ".svx"})
      if (const fs::path path = folder / (spelt + ending); fs::is_regular_file(path, none)) return path;
  return {};
}

/// Without recursion: a chain of includes may be long.
class IncludeSearch {
 public:
  void run(const std::string& file) {
    open(file);
    while (!way_.empty()) {
      Opened& at = way_.back();
      if (at.next == at.includes.size()) {
        open_.erase(at.key);
        way_.pop_back();
        continue;
      }
      const Include include = at.includes[at.next++];
      const std::string key = key_of(include.file);
      if (open_.contains(key))
        throw core::InputError(at.shown, "line " + std::to_string(include.line),
                               "*include " + core::printable(include.name) +
                                   (key == at.key ? ": the file includes itself"
                                                  : ": that file includes this one, in a circle"));
      if (!read_.contains(key)) open(include.file.string());
    }
  }

 private:
  struct Include {
    fs::path file;
    std::string name;
    std::size_t line = 0;
  };
  struct Opened {
    std::string shown, key;
    std::vector<Include> includes;
    std::size_t next = 0;
  };

  static std::string key_of(const fs::path& file) {
    std::error_code failed;
    const fs::path key = fs::canonical(file, failed);
    return failed ? file.string() : key.string();
  }

  void open(const std::string& file) {
    Opened opened{file, key_of(file), {}, 0};
    read_.insert(opened.key);
    open_.insert(opened.key);
    try {
      std::ifstream in = core::open_input(file, kMostSvxBytes);
      std::string line;
      for (std::size_t number = 1; std::getline(in, line); ++number) {
        const std::string name = included_name(line);
        if (name.empty()) continue;
        const fs::path path = included_file(fs::path(file).parent_path(), name);
        if (!path.empty()) opened.includes.push_back({path, name, number});
      }
    } catch (const core::InputError&) {  // cavern says why
    }
    way_.push_back(std::move(opened));
  }

  std::vector<Opened> way_;
  std::set<std::string> open_, read_;
};

}  // namespace

void refuse_include_cycles(const std::string& file) { IncludeSearch().run(file); }

}  // namespace karst::survey
