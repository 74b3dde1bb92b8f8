#include "sdk/host/plugin/discovery.h"

#include <sys/auxv.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "sdk/host/plugin/probe.h"
#include "sdk/host/plugin/script_file.h"

namespace karst::host {
namespace {

namespace fs = std::filesystem;

/// The environment of a process with raised privileges is set by the user who started it, so it is ignored.
std::string environment(const char* name) {
  if (getauxval(AT_SECURE) != 0) return "";
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

std::vector<std::string> split_path(const std::string& text) {
  std::vector<std::string> out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t colon = std::min(text.find(':', at), text.size());
    if (colon > at) out.push_back(text.substr(at, colon - at));
    at = colon + 1;
  }
  return out;
}

/// A file that was named gets so many times as long to open as one that was found: it may load a model.
constexpr double kNamed = 4;

std::vector<std::string> plugins_in(const std::string& folder) {
  std::vector<std::string> out;
  std::error_code error;
  for (const fs::directory_entry& e : fs::directory_iterator(folder, error)) {
    const bool is_candidate =
        e.path().extension() == ".so" || (is_script(e.path()) && may_hold_policy(e.path()));
    if (is_candidate && e.is_regular_file(error)) out.push_back(e.path().string());
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

SearchPath default_search_path(std::vector<std::string> plugin_files) {
  SearchPath path;
  path.files = std::move(plugin_files);
  path.folders = split_path(environment("KARST_PLUGIN_PATH"));
  const std::string data = environment("XDG_DATA_HOME"), home = environment("HOME");
  if (!data.empty())
    path.folders.push_back(data + "/karst/policies");
  else if (!home.empty())
    path.folders.push_back(home + "/.local/share/karst/policies");
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  if (!error) path.folders.push_back((self.parent_path().parent_path() / "lib/karst/policies").string());
  return path;
}

std::vector<PolicyListing> list_policies(const SearchPath& path) {
  std::vector<std::string> files = path.files;
  for (const std::string& folder : path.folders) {
    const std::vector<std::string> found = plugins_in(folder);
    files.insert(files.end(), found.begin(), found.end());
  }
  std::vector<PolicyListing> all;
  std::map<std::string, std::string> first_file;  // by id
  std::map<std::string, bool> seen;
  for (const std::string& file : files) {
    std::error_code error;
    const fs::path real = fs::weakly_canonical(file, error);
    if (!seen.emplace(error ? file : real.string(), true).second) continue;
    const bool is_named = std::find(path.files.begin(), path.files.end(), file) != path.files.end();
    for (PolicyListing& p : probe(file, (is_named ? kNamed : 1) * path.probe_limit_s)) {
      if (p.broken.empty()) {
        const auto [first, is_new] = first_file.emplace(p.id, p.file);
        if (!is_new) p.shadowed_by = first->second;
      }
      all.push_back(std::move(p));
    }
  }
  return all;
}

}  // namespace karst::host
