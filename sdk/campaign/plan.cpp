#include "sdk/campaign/plan.h"

#include <unistd.h>

#include <algorithm>
#include <boost/property_tree/info_parser.hpp>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core_stack/common/error.h"
#include "core_stack/common/info_lines.h"
#include "core_stack/common/options.h"
#include "plugins/simulator/cave/cave.h"
#include "sdk/campaign/hash.h"
#include "sdk/campaign/process.h"
#include "sdk/campaign/profile.h"

namespace karst::campaign {
namespace {

namespace fs = std::filesystem;
namespace pt = boost::property_tree;
using core::InputError;
using nlohmann::json;

constexpr double kCheckLimit_s = 600;  // for loading a policy and a cave, on a busy machine
constexpr std::size_t kShortHash = 12;

/// A file of our own that is gone at the end.
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

/// What a program said last, without the "karst: " in front.
std::string last_line(const std::string& text) {
  std::istringstream lines(text);
  std::string last;
  for (std::string line; std::getline(lines, line);)
    if (!line.empty()) last = line;
  return last.starts_with("karst: ") ? last.substr(7) : last;
}

std::string json_object(const Settings& settings) {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  for (const auto& [key, value] : settings) object[key] = value;
  return object.dump();
}

/// The mission of a contestant in a cave as `karst fly` would fly it.
pt::ptree resolve(const Campaign& c, const ContestantSpec& who, const CaveSpec& cave, const fs::path& karst) {
  const ScratchFile resolved;
  std::vector<std::string> argv = {karst.string(), "fly"};
  if (!c.mission.empty()) argv.push_back(c.mission);
  argv.insert(argv.end(), {"--check", resolved.path, "--policy", who.policy, "--cave", cave.file});
  if (!cave.start.empty()) argv.insert(argv.end(), {"--start", cave.start});
  if (!who.plugin.empty()) argv.insert(argv.end(), {"--plugin", who.plugin});
  const auto set = [&argv](const std::string& key, const std::string& value) {
    argv.insert(argv.end(), {"--set", key + "=" + value});
  };
  for (const Settings* some : {&profile(c.profile).settings, &c.settings, &who.settings})
    for (const auto& [key, value] : *some) set(key, value);
  set("mission.max_flight_time", json(c.flight_time_s).dump() + " s");
  for (const auto& [key, value] : who.parameters) set("policy.parameters." + key, value);
  const ProcessOutput checked = run_process(argv, kCheckLimit_s);
  if (checked.end.hung || checked.end.signal || checked.end.exit_code)
    throw InputError(c.source, "contestant " + who.name + " in cave " + cave.name,
                     checked.end.exit_code == 1 ? last_line(checked.out)
                                                : describe(checked.end) + ": " + last_line(checked.out));
  return core::read_info(resolved.path);
}

pt::ptree take(pt::ptree& tree, const std::string& section, const std::string& name) {
  pt::ptree taken;
  if (auto below = tree.get_child_optional(section)) {
    if (auto found = below->get_child_optional(name)) taken = *found;
    tree.get_child(section).erase(name);
    if (tree.get_child(section).empty()) tree.erase(section);
  }
  return taken;
}

fs::path vehicle_file(const fs::path& karst, const std::string& vehicle) {
  return karst.parent_path().parent_path() / "lib" / "karst" / "vehicles" / (vehicle + ".so");
}

/// "0.1.0+" and hashes of the program with its vehicle, and of the policy's plugin; what a karst was linked
/// with, such as Embree, is not in it.
std::string binary_version(const fs::path& karst, const std::string& vehicle, const std::string& version,
                           const std::string& plugin) {
  std::string parts = sha256_of_file(karst);
  if (const fs::path so = vehicle_file(karst, vehicle); fs::exists(so)) parts += sha256_of_file(so);
  return version + "+" + sha256(parts).substr(0, kShortHash) +
         (plugin.empty() ? "" : "." + sha256_of_file(plugin).substr(0, kShortHash));
}

/// The file that offers a policy.
std::string plugin_file(const std::string& policy, const std::string& plugin, const fs::path& karst) {
  std::vector<std::string> argv = {karst.string(), "policy", "list", "--json"};
  if (!plugin.empty()) argv.insert(argv.end(), {"--plugin", plugin});
  const json all = json::parse(run_process(argv, kCheckLimit_s).out, nullptr, false);
  if (all.is_object() && all.contains("policies"))
    for (const json& p : all["policies"])
      if (p.value("id", "") == policy && !p.contains("shadowed_by")) return p.value("file", "");
  return "";
}

PlannedContestant planned(const ContestantSpec& who, pt::ptree mission, const fs::path& karst) {
  const std::string policy = mission.get("policy.name", who.policy);  // what `auto` chose
  PlannedContestant out{who.name, policy, who.plugin, {}, {}, {}, json_object(who.settings), {}};
  out.version = take(mission, "policy", "version").data();
  const std::string karst_version = take(mission, "karst", "version").data();
  take(mission, "vehicle", "implementation");
  if (const auto parameters = mission.get_child_optional("policy.parameters"))
    out.parameters = json_object(core::leaves_of(*parameters));
  if (out.parameters.empty()) out.parameters = "{}";
  mission.erase("cave");
  mission.erase("seed");
  out.binary_version = binary_version(karst, mission.get("vehicle", ""), karst_version,
                                      plugin_file(policy, who.plugin, karst));
  out.mission.swap(mission);
  return out;
}

PlannedCave planned(const CaveSpec& cave) {
  const cave::CaveDescription description = cave::describe_cave(cave.file, cave.start);
  PlannedCave out{cave.name, cave.file, cave.start, sha256_of_file(description.mesh_path), {}};
  std::string said;
  if (fs::path(description.mesh_path).lexically_normal() != fs::path(cave.file).lexically_normal())
    for (const core::InfoLine& line : core::info_lines(cave.file)) said += line.text + "\n";
  out.hash = sha256(out.mesh_hash + "\n" + said);
  return out;
}

double seconds_of(const pt::ptree& mission, const std::string& key, double otherwise) {
  const auto text = mission.get_optional<std::string>(key);
  if (!text) return otherwise;
  double s = otherwise;
  core::OptionTable table;
  table.add(key, s, "s", 0, 1e9, "");
  table.set("mission", key, *text);
  return s;
}

/// Until when the longest-flying contestant may explore: flight time, or what its battery lasts.
double horizon_of(const std::vector<PlannedContestant>& contestants) {
  double horizon = 0;
  for (const PlannedContestant& c : contestants)
    horizon = std::max(horizon, std::min(seconds_of(c.mission, "mission.max_flight_time", 1e9),
                                         seconds_of(c.mission, "simulator.battery_minutes", 1e9)));
  return horizon;
}

std::string info_text(const pt::ptree& tree) {
  std::ostringstream out;
  pt::write_info(out, tree);
  return out.str();
}

using Facts = std::map<std::string, std::string>;

Facts facts_of(const PlannedContestant& c, bool any_binary) {
  Facts facts{{"policy", c.policy}, {"plugin", c.plugin}};
  if (!any_binary) facts["binary"] = c.binary_version, facts["version"] = c.version;
  for (const auto& [key, value] : core::leaves_of(c.mission)) facts[key] = value;
  return facts;
}
Facts facts_of(const PlannedCave& c, bool) { return {{"start", c.start}, {"content", c.hash.substr(0, 12)}}; }

void compare_facts(const std::string& what, const Facts& then, const Facts& now,
                   std::vector<std::string>& out) {
  const auto value = [](const Facts& facts, const std::string& key) {
    const auto found = facts.find(key);
    return found == facts.end() ? std::string("not there") : "\"" + found->second + "\"";
  };
  Facts both = then;
  both.insert(now.begin(), now.end());
  for (const auto& [key, ignored] : both) {
    const std::string was = value(then, key), is = value(now, key);
    if (was == is) continue;
    std::string& text = out.emplace_back(what);
    text.append(": ").append(key).append(" was ").append(was).append(", is ").append(is);
  }
}

template <class Named>
void compare_lists(const std::string& what, const std::vector<Named>& then, const std::vector<Named>& now,
                   bool any_binary, std::vector<std::string>& out) {
  for (std::size_t i = 0; i < then.size(); ++i) {
    if (i >= now.size() || now[i].name != then[i].name)
      out.push_back(what + " " + std::to_string(i + 1) + " was " + then[i].name + ", is " +
                    (i < now.size() ? now[i].name : "missing"));
    else
      compare_facts(what + " " + then[i].name, facts_of(then[i], any_binary), facts_of(now[i], any_binary),
                    out);
  }
}

std::string seeds_text(const std::vector<std::int64_t>& seeds) {
  std::string text;
  for (const std::int64_t s : seeds) text += (text.empty() ? "" : " ") + std::to_string(s);
  return text;
}

/// A contestant is one policy: `auto` may not choose another one in another cave.
void refuse_other_choice(const Campaign& c, const ContestantSpec& who, const PlannedContestant& first,
                         const fs::path& karst) {
  const auto chosen = [](const pt::ptree& mission) {
    return std::pair(mission.get("policy.name", ""), mission.get_child("policy.parameters", {}));
  };
  for (std::size_t i = 1; i < c.caves.size(); ++i)
    if (chosen(resolve(c, who, c.caves[i], karst)) != chosen(first.mission))
      throw InputError(c.source, "contestant " + who.name,
                       "auto chooses otherwise in cave " + c.caves[i].name + " than in " + c.caves[0].name +
                           "; make a campaign of each, or name what is chosen as contestants");
}

}  // namespace

Plan make_plan(const Campaign& c, const fs::path& karst) {
  Plan plan;
  plan.name = c.name;
  plan.profile = c.profile;
  plan.trial_timeout_s = c.trial_timeout_s;
  plan.seeds = c.seeds;
  for (const CaveSpec& cave : c.caves) plan.caves.push_back(planned(cave));
  for (const ContestantSpec& who : c.contestants) {
    plan.contestants.push_back(planned(who, resolve(c, who, c.caves.front(), karst), karst));
    if (plan.contestants.back().policy != who.policy)
      refuse_other_choice(c, who, plan.contestants.back(), karst);
  }
  for (std::size_t i = 1; i < c.caves.size(); ++i) resolve(c, c.contestants.front(), c.caves[i], karst);
  plan.horizon_s = horizon_of(plan.contestants);
  return plan;
}

Plan with_present_files(Plan plan, const fs::path& karst) {
  for (PlannedCave& c : plan.caves) c = planned(CaveSpec{c.name, c.file, c.start});
  for (PlannedContestant& c : plan.contestants) {
    const std::string karst_version = c.binary_version.substr(0, c.binary_version.find('+'));
    c.binary_version = binary_version(karst, c.mission.get("vehicle", ""), karst_version,
                                      plugin_file(c.policy, c.plugin, karst));
  }
  return plan;
}

std::vector<fs::path> binaries_of(const Plan& plan, const fs::path& karst) {
  std::vector<fs::path> files{karst};
  for (const PlannedContestant& c : plan.contestants) {
    files.push_back(vehicle_file(karst, c.mission.get("vehicle", "")));
    files.emplace_back(plugin_file(c.policy, c.plugin, karst));
  }
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  files.erase(std::remove_if(files.begin(), files.end(), [](const fs::path& f) { return !fs::exists(f); }),
              files.end());
  return files;
}

std::string definition_of(const Plan& plan) {
  pt::ptree tree;
  tree.put("name", plan.name);
  tree.put("profile", plan.profile);
  tree.put("horizon_s", json(plan.horizon_s).dump());
  tree.put("trial_timeout_s", json(plan.trial_timeout_s).dump());
  tree.put("seeds", seeds_text(plan.seeds));
  for (const PlannedCave& c : plan.caves) {
    pt::ptree& block = tree.add("cave", "");
    block.put("name", c.name);
    block.put("file", c.file);
    block.put("start", c.start);
    block.put("mesh_hash", c.mesh_hash);
    block.put("hash", c.hash);
  }
  for (const PlannedContestant& c : plan.contestants) {
    pt::ptree& block = tree.add("contestant", "");
    block.put("name", c.name);
    block.put("policy", c.policy);
    block.put("plugin", c.plugin);
    block.put("version", c.version);
    block.put("binary_version", c.binary_version);
    block.put("parameters", c.parameters);
    block.put("settings", c.settings);
    block.put_child("mission", c.mission);
  }
  return info_text(tree);
}

Plan plan_of(const std::string& definition, const std::string& source) {
  Plan plan;
  try {
    std::istringstream in(definition);
    pt::ptree tree;
    pt::read_info(in, tree);
    plan.name = tree.get<std::string>("name");
    plan.profile = tree.get<std::string>("profile");
    plan.horizon_s = tree.get<double>("horizon_s");
    plan.trial_timeout_s = tree.get<double>("trial_timeout_s");
    std::istringstream seeds(tree.get<std::string>("seeds"));
    for (std::int64_t seed = 0; seeds >> seed;) plan.seeds.push_back(seed);
    for (const auto& [key, b] : tree) {
      const auto text = [&block = b](const char* name) { return block.get<std::string>(name); };
      if (key == "cave")
        plan.caves.push_back({text("name"), text("file"), text("start"), text("mesh_hash"), text("hash")});
      if (key == "contestant")
        plan.contestants.push_back({text("name"), text("policy"), text("plugin"), text("version"),
                                    text("binary_version"), text("parameters"), text("settings"),
                                    b.get_child("mission")});
    }
  } catch (const pt::ptree_error& e) {
    throw InputError(source, "campaign.definition", e.what());
  }
  return plan;
}

StoreHead head_of(const Plan& plan) {
  StoreHead head{plan.name, definition_of(plan), plan.horizon_s, {}, {}, plan.seeds};
  for (const PlannedContestant& c : plan.contestants)
    head.contestants.push_back({c.name, c.policy, c.version, c.parameters, c.settings});
  for (const PlannedCave& c : plan.caves) head.caves.push_back({c.name, c.file, c.start, "", c.mesh_hash});
  return head;
}

std::vector<std::string> changes(const Plan& then, const Plan& now, bool any_binary) {
  std::vector<std::string> out;
  compare_lists("contestant", then.contestants, now.contestants, any_binary, out);
  compare_lists("cave", then.caves, now.caves, any_binary, out);
  if (now.seeds.size() < then.seeds.size() ||
      !std::equal(then.seeds.begin(), then.seeds.end(), now.seeds.begin()))
    out.push_back("seeds were " + seeds_text(then.seeds) + ", are " + seeds_text(now.seeds));
  return out;
}

std::vector<TrialKey> trials_of(const Plan& plan) {
  std::vector<TrialKey> trials;
  for (std::size_t k = 0; k < plan.contestants.size(); ++k)
    for (std::size_t c = 0; c < plan.caves.size(); ++c)
      for (const std::int64_t seed : plan.seeds) trials.emplace_back(k, c, seed);
  return trials;
}

std::string mission_text(const Plan& plan, std::size_t contestant, std::size_t cave) {
  pt::ptree mission = plan.contestants.at(contestant).mission;
  mission.put("cave.file", plan.caves.at(cave).file);
  mission.put("cave.start", plan.caves.at(cave).start);
  return info_text(mission);
}

std::string mission_hash(const Plan& plan, const TrialKey& trial) {
  const auto& [contestant, cave, seed] = trial;
  const PlannedCave& c = plan.caves.at(cave);
  return sha256(info_text(plan.contestants.at(contestant).mission) + "\ncave " + c.hash + "\nstart " +
                c.start + "\nseed " + std::to_string(seed) + "\n");
}

}  // namespace karst::campaign
