#include "sdk/flight/mission_file.h"

#include <algorithm>
#include <filesystem>

#include "core_stack/common/error.h"
#include "core_stack/common/info_lines.h"
#include "core_stack/common/info_reader.h"
#include "core_stack/common/install_location.h"
#include "core_stack/common/random.h"
#include "core_stack/vehicle/load_vehicle.h"
#include "plugins/simulator/simulated_world.h"
#include "sdk/flight/auto_options.h"
#include "sdk/selection/preset.h"

namespace karst::flight {
namespace {

namespace pt = boost::property_tree;
using core::InputError;
using core::OptionTable;

constexpr const char *kParameters = "policy.parameters", *kAuto = "policy.auto", *kLater = "policy.later",
                     *kSelection = "policy.selection";
constexpr const char *kSurveySection = "survey", *kRegionSection = "region";
constexpr const char* kEarlierMapKeys[] = {"start", "start_digest", "required", "search_time"};
constexpr const char *kPolicyVersion = "policy.version", *kKarstVersion = "karst.version";

struct AutoKeys {
  AutoOptions options;
  FixedChoice fixed;
  LaterPolicy later;
};

/// With `auto_keys` the keys of policy.auto are there, too: for help, since no flight records them.
void describe_mission(OptionTable& t, Mission& m, AutoKeys* auto_keys = nullptr) {
  t.add("seed", m.seed, 0, 9e15, "seed of every random stream of the mission");
  t.add("vehicle", m.vehicle, {}, "the vehicle's plugin");
  t.under("cave", [&m](OptionTable& c) {
    c.add("file", m.cave, {},
          "cave .info file, or a mesh (STL, PLY, OBJ, DAE); relative to the mission file");
    c.add("start", m.start, {},
          "\"x y z [heading_deg]\" above the floor to start from; empty: the cave's own");
    describe(c, m.mesh);
  });
  t.under("survey", [&m](OptionTable& s) {
    s.add("file", m.survey.file, {},
          "survey of passages that are known before the flight: Therion (.th), Survex (.svx, .3d) or Compass "
          "(.dat, .mak, .plt); relative to the mission file");
    s.add(
        "offset", m.survey.offset, {},
        "\"x y z\" of the cave's origin in the survey, m; empty: by the stations of karst cave from-survey, "
        "or 0 0 0 for a cave without them");
    s.add("hints", m.survey.hints,
          "tell the policy of it; false: only what the survey lacks is counted, for comparisons");
  });
  t.under("map", [&m](OptionTable& s) {
    s.add("start", m.earlier.start, {},
          "map of an earlier flight of the same cave, in which the vehicle looks for its place: a run "
          "directory, "
          "or its map.bt or map.ot; relative to the mission file");
    s.add("start_digest", m.earlier.digest, {},
          "SHA-256 of the file of map.start, which is recorded; another one is refused; empty: any");
    s.add("required", m.core.earlier.required,
          "it explores only with its place in map.start: it hovers and looks for it for map.search_time, and "
          "then lands; false: it explores as without the map meanwhile");
    s.add(
        "search_time", m.core.earlier.search_time_s, "s", 0, 3600,
        "after the first hover, the vehicle looks for its place in map.start again and again for this long; "
        "with map.required it hovers meanwhile");
  });
  t.section(kRegionSection, m.region);
  t.under("record", [&m](OptionTable& r) {
    r.add("scans", m.record.scans,
          "keep the vehicle's scans, IMU, compass and barometer in the folder scans of the run directory, "
          "which "
          "karst replay reads; a scan has up to 22 bytes a point");
  });
  t.under("policy", [&m, auto_keys](OptionTable& p) {
    p.add("name", m.policy, {},
          "the exploration policy; `karst policy list` shows what there is; auto: selected by policy.auto");
    p.add("stream", m.policy_stream, 0, 9e15,
          "gives the policy other random numbers, and nothing else: for comparing a policy with itself");
    p.add("isolation", m.policy_isolation,
          "process: the policy runs in a process of its own, where a crash costs the policy and not the "
          "vehicle; where_possible: the same, or in_process where this machine cannot confine a process");
    p.add("cpu_limit", m.policy_cpu_limit_s, "s", 0.1, 3600,
          "processor time a call may take: of its thread, or of all threads of the policy's own process");
    p.add("hang_limit", m.policy_hang_limit_s, "s", 0.1, 3600,
          "by the wall clock, for calls that wait for ever; with --real-time cpu_limit if that is less, "
          "mission.decision_period of a policy in a process of its own");
    p.add("memory_limit_mib", m.policy_memory_limit_mib, 256, 1 << 20,
          "address space of a policy in a process of its own, in MiB");
    if (!auto_keys) return;
    p.section("later", auto_keys->later);
    p.section("auto", auto_keys->options);
    p.section("auto.cave", auto_keys->fixed);
  });
  describe(t, m.core);
  t.section("real_time", m.real_time);
  t.section("team", m.core.team);
  t.section("team", m.faults);
  t.section("homing", m.core.homing);
}

void describe_radio(OptionTable& table, core::VehiclePlugin& plugin) {
  if (auto* teams = dynamic_cast<sim::SimulatedWorldPlugin*>(&plugin))
    table.under("radio", [teams](OptionTable& t) { teams->describe_radio(t); });
}

/// The sections that apply to teams only.
constexpr const char* kTeamSections[] = {"team", "homing", "radio"};

/// Puts a setting below `prefix` into `tree`; returns whether `key` was one.
bool put_below(const std::string& prefix, const std::string& key, const std::string& value, pt::ptree& tree) {
  if (!key.starts_with(prefix + ".")) return false;
  tree.put(key.substr(prefix.size() + 1), value);
  return true;
}

/// A path given on the command line is relative to the working directory, not to the mission file.
std::string as_given(const std::string& key, const std::string& value) {
  const bool path =
      key == "policy.auto.description" || key == "policy.auto.survey" || key == "policy.auto.results";
  return path && !value.empty() ? std::filesystem::absolute(value).string() : value;
}

/// Removes the subtree "section.name" from `tree` and returns it; a section left empty is removed, too.
pt::ptree take(pt::ptree& tree, const std::string& key) {
  const auto found = tree.get_child_optional(key);
  if (!found) return {};
  pt::ptree taken = *found;
  const std::string section = key.substr(0, key.find('.'));
  pt::ptree& rest = tree.get_child(section);
  rest.erase(key.substr(section.size() + 1));
  if (rest.empty() && rest.data().empty()) tree.erase(section);
  return taken;
}

OptionTable table_of(LaterPolicy& later) {
  OptionTable table;
  describe(table, later);
  table.add("selection", later.selection, {}, "");
  return table;
}

pt::ptree recorded(const LaterPolicy& later) {
  LaterPolicy copy = later;
  pt::ptree tree = table_of(copy).resolved();
  if (later.selection.empty()) tree.erase("selection");
  if (!later.parameters.empty()) tree.put_child("parameters", later.parameters);
  return tree;
}

/// The policy that takes over, as policy.later gives it; nothing if it is not given.
std::optional<LaterPolicy> later_policy(pt::ptree tree, const std::string& file) {
  if (tree.empty() && tree.data().empty()) return std::nullopt;
  LaterPolicy later;
  later.parameters = tree.get_child("parameters", {});
  tree.erase("parameters");
  OptionTable table = table_of(later);
  for (const auto& [key, child] : tree) table.set(file + ": " + kLater, key, child.data());
  if (later.policy.empty()) throw InputError(file, kLater, "lacks the name of the policy");
  if (!(later.after_s > 0)) throw InputError(file, kLater, "lacks its time: after \"60 s\"");
  return later;
}

std::pair<std::string, std::string> split_setting(const std::string& setting) {
  const auto equals = setting.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError("--set", setting, "expected key=value, such as motion.max_speed=1.5");
  return {setting.substr(0, equals), setting.substr(equals + 1)};
}

/// As the settings say, or else the mission file.
std::string vehicle_of(const pt::ptree& tree,
                       const std::vector<std::pair<std::string, std::string>>& settings) {
  std::string vehicle = tree.get("vehicle", Mission{}.vehicle);
  for (const auto& [key, value] : settings)
    if (key == "vehicle") vehicle = value;
  return vehicle;
}

std::vector<std::pair<std::string, std::string>> settings_of(const MissionOverrides& overrides) {
  std::vector<std::pair<std::string, std::string>> settings;
  for (const std::string& s : overrides.settings) settings.push_back(split_setting(s));
  settings.insert(settings.end(), overrides.values.begin(), overrides.values.end());
  return settings;
}

/// The same file serves a mission of another vehicle: that one's section has no meaning then. But a file for
/// this vehicle may mean a section of this vehicle's own, such as simulated_autopilot.simulator.
void leave_out_others(const Mission& m, const OptionTable& table, pt::ptree& tree) {
  const bool for_this_vehicle = tree.get("vehicle", "") == m.vehicle;
  for (const std::string& other : core::vehicles_in(core::plugin_root() / "vehicles")) {
    if (other == m.vehicle || !tree.get_child_optional(other)) continue;
    const std::string meant = m.vehicle + "." + other;
    const bool has = std::any_of(table.rows().begin(), table.rows().end(),
                                 [&meant](const auto& row) { return row.key.starts_with(meant + "."); });
    if (for_this_vehicle && has)
      throw InputError(m.file, other,
                       "has no effect on the vehicle " + m.vehicle + ": write it as " + meant + ", " +
                           m.vehicle + " { " + other + " { ... } }");
    tree.erase(other);
  }
}

}  // namespace

void describe(OptionTable& t, LaterPolicy& later) {
  t.add("after", later.after_s, "s", 0, 1e6,
        "from the first decision at this time on, by the vehicle's clock, another policy decides");
  t.add("name", later.policy, {}, "that policy; a block parameters { } beside it holds its parameters");
}

std::string named_vehicle(const std::string& file, const MissionOverrides& overrides) {
  return vehicle_of(file.empty() ? pt::ptree() : core::read_including_info(file), settings_of(overrides));
}

Mission read_mission(const std::string& file, const MissionOverrides& overrides) {
  Mission m;
  m.file = file.empty() ? "command line" : file;
  pt::ptree tree = file.empty() ? pt::ptree() : core::read_including_info(file);
  if (tree.get_optional<std::string>("mesh"))
    throw InputError(m.file, "", "is a cave file; fly it with karst fly --cave " + m.file);
  m.policy_parameters = take(tree, kParameters);  // only the policy itself knows the valid keys
  if (!m.policy_parameters.data().empty())
    throw InputError(m.file, kParameters,
                     "expected a block { ... }, got \"" + m.policy_parameters.data() + "\"");
  m.auto_policy = take(tree, kAuto);
  if (!m.auto_policy.data().empty())
    throw InputError(m.file, kAuto, "expected a block { ... }, got \"" + m.auto_policy.data() + "\"");
  pt::ptree later = take(tree, kLater);
  m.policy_selection = take(tree, kSelection).data();
  for (const char* fact : {kPolicyVersion, kKarstVersion}) take(tree, fact);

  const auto settings = settings_of(overrides);
  const auto set_to = [&settings](const char* wanted) {
    return std::any_of(settings.begin(), settings.end(), [&](const auto& s) { return s.first == wanted; });
  };
  const auto refuse_both = [&](const std::string& option, const char* flag, const char* key) {
    if (!option.empty() && set_to(key))
      throw InputError("--set", key, std::string("is given by ") + flag + " as well");
  };
  refuse_both(overrides.cave, "--cave", "cave.file");
  refuse_both(overrides.start, "--start", "cave.start");
  refuse_both(overrides.policy, "--policy", "policy.name");
  refuse_both(overrides.preset, "--preset", "policy.name");
  if (!overrides.policy.empty() && !overrides.preset.empty())
    throw InputError("--preset", overrides.preset, "names a policy, and --policy one as well");

  // The vehicle comes first: its plugin adds its own section to the table.
  m.vehicle = vehicle_of(tree, settings);
  m.vehicle_plugin = &core::load_vehicle(m.vehicle, core::plugin_root() / "vehicles");
  OptionTable table;
  describe_mission(table, m);
  table.under(m.vehicle, [&m](OptionTable& t) { m.vehicle_plugin->describe_options(t); });
  describe_radio(table, *m.vehicle_plugin);
  leave_out_others(m, table, tree);

  table.read(m.file, tree);
  m.cave = core::beside(file, m.cave);
  m.core.team.key_file = core::beside(file, m.core.team.key_file);
  m.survey.file = core::beside(file, m.survey.file);
  m.earlier.start = core::beside(file, m.earlier.start);
  const std::string recorded_policy = m.policy;
  if (!overrides.cave.empty()) {  // another cave, another start and mesh
    m.cave = overrides.cave;
    m.start = "";
    m.mesh = {};
  }
  for (const auto& [key, value] : settings)
    if (!put_below(kParameters, key, value, m.policy_parameters) &&
        !put_below(kAuto, key, as_given(key, value), m.auto_policy) && !put_below(kLater, key, value, later))
      table.set("--set", key, value);
  if (!overrides.start.empty()) m.start = overrides.start;
  const auto other_policy = [&](const std::string& name, const pt::ptree& parameters) {
    m.policy = name;
    m.policy_parameters = parameters;  // another policy, other parameters
    for (const auto& [key, value] : settings) put_below(kParameters, key, value, m.policy_parameters);
  };
  if (!overrides.policy.empty() && overrides.policy != m.policy) other_policy(overrides.policy, {});
  if (!overrides.preset.empty()) {
    const selection::PolicyPreset preset = selection::read_preset(overrides.preset);
    other_policy(preset.policy, preset.parameters);
    m.policy_selection.clear();
  }
  if (m.policy != recorded_policy) {
    m.policy_selection.clear();
    const auto names_later = [](const std::string& setting) { return setting.starts_with("policy.later."); };
    if (std::none_of(overrides.settings.begin(), overrides.settings.end(), names_later)) later = {};
  }
  m.later = later_policy(later, m.file);
  m.resolved = table.resolved();
  if (m.core.team.robots == 1)
    for (const char* section : kTeamSections) m.resolved.erase(section);
  if (m.survey.file.empty()) {
    if (!m.survey.offset.empty())
      throw InputError(m.file, "survey.offset", "is of no use without survey.file");
    m.resolved.erase(kSurveySection);
  }
  if (m.earlier.start.empty()) {
    if (m.core.earlier.required) throw InputError(m.file, "map.required", "is of no use without map.start");
    for (const char* key : kEarlierMapKeys) m.resolved.get_child("map").erase(key);
  }
  m.core.region = core::region_of(m.file, m.region);
  if (!m.core.region) m.resolved.erase(kRegionSection);
  return m;
}

std::uint64_t policy_seed(const Mission& m) {
  const auto seed = static_cast<std::uint64_t>(m.seed);
  if (m.policy_stream == 0) return seed;
  return core::Random::stream(seed, "policy stream " + std::to_string(m.policy_stream)).bits();
}

pt::ptree recorded_mission(const Mission& m, const pt::ptree& policy_parameters,
                           const std::string& policy_version) {
  pt::ptree tree = m.resolved;
  tree.put("cave.file", m.cave.empty() ? "" : std::filesystem::absolute(m.cave).lexically_normal().string());
  tree.put("cave.start", m.start);
  if (const std::string& key = m.core.team.key_file; !key.empty() && tree.get_child_optional("team"))
    tree.put("team.key_file", std::filesystem::absolute(key).lexically_normal().string());
  if (!m.survey.file.empty()) {
    tree.put("survey.file", std::filesystem::absolute(m.survey.file).lexically_normal().string());
    tree.put("survey.offset", m.survey.offset);
  }
  if (!m.earlier.start.empty()) {
    tree.put("map.start", std::filesystem::absolute(m.earlier.start).lexically_normal().string());
    tree.put("map.start_digest", m.earlier.digest);
  }
  tree.put("policy.name", m.policy);
  if (!policy_parameters.empty()) tree.put_child(kParameters, policy_parameters);
  tree.put(kPolicyVersion, policy_version);
  if (!m.policy_selection.empty()) tree.put(kSelection, m.policy_selection);
  if (m.later) tree.put_child(kLater, recorded(*m.later));
  tree.put(kKarstVersion, KARST_VERSION);
  return tree;
}

std::string mission_help(const std::string& vehicle) {
  Mission m;
  AutoKeys auto_keys;
  OptionTable table;
  describe_mission(table, m, &auto_keys);
  core::VehiclePlugin& plugin = core::load_vehicle(vehicle, core::plugin_root() / "vehicles");
  table.under(vehicle, [&plugin](OptionTable& t) { plugin.describe_options(t); });
  describe_radio(table, plugin);
  return table.help();
}

}  // namespace karst::flight
