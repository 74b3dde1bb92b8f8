#include "sdk/campaign/plan/ask_karst.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>

#include "core_stack/common/error.h"
#include "core_stack/common/info_reader.h"
#include "core_stack/common/json_text.h"
#include "core_stack/common/options.h"
#include "sdk/campaign/plan/hash.h"
#include "sdk/campaign/plan/profile.h"
#include "sdk/host/isolation/process.h"

namespace karst::campaign {
namespace {

namespace fs = std::filesystem;
namespace pt = boost::property_tree;
using core::InputError;
using host::ProcessOutput;
using host::run_process;
using nlohmann::json;

constexpr double kCheckLimit_s = 600;  // for loading a policy and a cave, on a busy machine
constexpr std::size_t kShortHash = 12;
constexpr const char* kIsolation = "policy.isolation";

/// A temporary file, removed on destruction.
struct ScratchFile {
  ScratchFile() {
    const int descriptor = mkstemp(path.data());
    if (descriptor < 0) throw InputError(path, "", "cannot be made");
    close(descriptor);
  }
  ~ScratchFile() { std::remove(path.c_str()); }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  std::string path = (fs::temp_directory_path() / "karst-mission-XXXXXX").string();
};

/// The last line that a program printed, without its "karst: " prefix.
std::string last_line(const std::string& text) {
  std::istringstream lines(text);
  std::string last;
  for (std::string line; std::getline(lines, line);)
    if (!line.empty()) last = line;
  return last.starts_with("karst: ") ? last.substr(7) : last;
}

bool has(const Settings& settings, const std::string& key) {
  return std::any_of(settings.begin(), settings.end(), [&](const auto& s) { return s.first == key; });
}

/// Whether the campaign says where its policies run. What is wrong in its mission file is for karst to say.
bool says_where_policies_run(const Campaign& c, const ContestantSpec& who) {
  for (const Settings* some : {&c.settings, &c.overrides, &who.settings})
    if (has(*some, kIsolation)) return true;
  if (c.mission.empty()) return false;
  try {
    return core::read_including_info(c.mission).get_optional<std::string>(kIsolation).has_value();
  } catch (const InputError&) {
    return false;
  }
}

std::string without(std::string text, const std::string& part) {
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part))
    text.erase(at, part.size());
  return text;
}

/// Turns karst's message about a setting, passed as an option, into one about the entry that sets it.
InputError complaint(const Campaign& c, const ContestantSpec& who, const CaveSpec& cave,
                     const std::string& said) {
  const std::string contestant = "contestant " + who.name, parameter = "policy.parameters.",
                    start = cave.file + ": start: ";
  if (!cave.start.empty() && said.starts_with(start))
    return {c.source, "cave " + cave.name, said.substr(cave.file.size() + 2)};
  for (const std::string_view option : {std::string_view("command line: "), std::string_view("--set: ")}) {
    if (!said.starts_with(option)) continue;
    const std::string rest = said.substr(option.size()), key = rest.substr(0, rest.find(": "));
    if (key.starts_with(parameter)) return {c.source, contestant, "parameters." + without(rest, parameter)};
    if (has(who.settings, key)) return {c.source, contestant, "settings." + rest};
    if (has(c.overrides, key)) return {"command line", "--set", rest};
    if (has(c.settings, key)) return {c.source, "", "settings." + rest};
  }
  return {c.source, contestant + " in cave " + cave.name, said};
}

}  // namespace

pt::ptree resolve(const Campaign& c, const ContestantSpec& who, const CaveSpec& cave, const fs::path& karst,
                  const fs::path& cave_cache) {
  const ScratchFile resolved;
  std::vector<std::string> argv = {karst.string(), "fly"};
  if (!c.mission.empty()) argv.push_back(c.mission);
  argv.insert(argv.end(), {"--check", resolved.path, "--policy", who.policy, "--cave", cave.file});
  if (!cave.start.empty()) argv.insert(argv.end(), {"--start", cave.start});
  if (!who.plugin.empty()) argv.insert(argv.end(), {"--plugin", who.plugin});
  if (!cave_cache.empty()) argv.insert(argv.end(), {"--cave-cache", cave_cache.string()});
  const auto set = [&argv](const std::string& key, const std::string& value) {
    argv.insert(argv.end(), {"--set", key + "=" + value});
  };
  for (const Settings* some : {&profile(c.profile).settings, &c.settings, &c.overrides, &who.settings})
    for (const auto& [key, value] : *some) set(key, value);
  // Each trial is a process of its own already, and a policy that crashes in it has failed. With isolation
  // the fallback policy would fly on in its name.
  if (!says_where_policies_run(c, who)) set(kIsolation, "in_process");
  set("mission.max_flight_time", core::json_text(json(c.flight_time_s)) + " s");
  for (const auto& [key, value] : who.parameters) set("policy.parameters." + key, value);
  const ProcessOutput checked = run_process(argv, kCheckLimit_s);
  if (checked.end.hung || checked.end.signal || checked.end.exit_code)
    throw complaint(c, who, cave,
                    checked.end.exit_code == 1 ? last_line(checked.out)
                                               : describe(checked.end) + ": " + last_line(checked.out));
  return core::read_info(resolved.path);
}

fs::path vehicle_file(const fs::path& karst, const std::string& vehicle) {
  return karst.parent_path().parent_path() / "lib" / "karst" / "vehicles" / (vehicle + ".so");
}

std::string binary_version(const fs::path& karst, const std::string& vehicle, const std::string& version,
                           const std::string& plugin) {
  std::string parts = sha256_of_file(karst);
  if (const fs::path so = vehicle_file(karst, vehicle); fs::exists(so)) parts += sha256_of_file(so);
  return version + "+" + sha256(parts).substr(0, kShortHash) +
         (plugin.empty() ? "" : "." + sha256_of_file(plugin).substr(0, kShortHash));
}

std::string plugin_file(const std::string& policy, const std::string& plugin, const fs::path& karst) {
  std::vector<std::string> argv = {karst.string(), "policy", "list", "--json"};
  if (!plugin.empty()) argv.insert(argv.end(), {"--plugin", plugin});
  const json all = core::json_of(run_process(argv, kCheckLimit_s).out);
  if (all.is_object() && all.contains("policies"))
    for (const json& p : all["policies"])
      if (p.value("id", "") == policy && !p.contains("shadowed_by")) return p.value("file", "");
  return "";
}

}  // namespace karst::campaign
