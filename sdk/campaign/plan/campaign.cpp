#include "sdk/campaign/plan/campaign.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <optional>
#include <set>
#include <sstream>

#include "core_stack/common/error.h"
#include "core_stack/common/info_lines.h"
#include "core_stack/common/options.h"
#include "sdk/campaign/plan/profile.h"
#include "sdk/evaluation/metrics/metric_definitions.h"
#include "sdk/host/plugin/selection.h"

namespace karst::campaign {
namespace {

namespace fs = std::filesystem;
namespace pt = boost::property_tree;
using core::InputError;
using core::OptionTable;

constexpr std::int64_t kMaxSeeds = 100'000;

/// Removes the blocks of this name from the tree and returns them.
std::vector<pt::ptree> take_blocks(pt::ptree& tree, const std::string& name) {
  std::vector<pt::ptree> blocks;
  for (const auto& [key, child] : tree)
    if (key == name) blocks.push_back(child);
  tree.erase(name);
  return blocks;
}

std::vector<std::string> metric_names() {
  std::vector<std::string> names;
  for (const evaluation::MetricDefinition& m : evaluation::metric_definitions()) names.emplace_back(m.name);
  return names;
}

/// The leaves of a block that may occur at most once.
Settings take_settings(pt::ptree& tree, const std::string& name, const std::string& source,
                       const std::string& place) {
  const std::vector<pt::ptree> blocks = take_blocks(tree, name);
  if (blocks.empty()) return {};
  if (blocks.size() > 1) throw InputError(source, place + name, "given twice");
  if (!blocks[0].data().empty())
    throw InputError(source, place + name, "expected a block { ... }, got \"" + blocks[0].data() + "\"");
  Settings settings = core::leaves_of(blocks[0]);
  const std::string at = place + name;
  std::set<std::string> seen;
  for (const auto& [key, value] : settings)
    if (!seen.insert(key).second)
      throw InputError(source, std::string(at).append(".").append(key), "given twice");
  return settings;
}

/// Refuses keys that a campaign determines by other means than settings.
void refuse_reserved(const Campaign& c, const std::string& place, const Settings& settings) {
  const std::vector<std::pair<std::string, std::string>> reserved = {
      {"seed", "seeds or seed_list"},
      {"cave.", "the blocks `cave`"},
      {"policy.name", "contestant.policy"},
      {"policy.parameters.", "contestant.parameters"},
      {"mission.max_flight_time", "flight_time"}};
  for (const auto& [key, value] : settings)
    for (const auto& [what, instead] : reserved)
      if (what.back() == '.' ? key.starts_with(what) : key == what)
        throw InputError(c.source, place + key, "is given by " + instead + " in a campaign");
}

std::vector<std::int64_t> parse_seeds(const std::string& source, std::int64_t count,
                                      const std::string& list) {
  std::vector<std::int64_t> seeds;
  if (list.empty()) {
    for (std::int64_t s = 1; s <= count; ++s) seeds.push_back(s);
    return seeds;
  }
  if (count > 0) throw InputError(source, "seed_list", "is given beside seeds");
  std::istringstream words(list);
  for (std::string word; words >> word;) {
    std::int64_t seed = 0;
    OptionTable table;
    table.add("seed_list", seed, 0, 9e15, "");
    table.set(source, "seed_list", word);
    if (std::find(seeds.begin(), seeds.end(), seed) != seeds.end())
      throw InputError(source, "seed_list", "holds " + word + " twice");
    seeds.push_back(seed);
  }
  return seeds;
}

/// Names the key that a block with a wrong name may mean; the table, which has no blocks, knows none.
void refuse_other_blocks(const pt::ptree& tree, const std::string& source, const std::string& place,
                         const std::vector<std::string>& known) {
  for (const auto& [key, child] : tree) {
    if (child.empty()) continue;
    const std::string near = core::nearest_name(key, known);
    if (!near.empty())
      throw InputError(source, place + key, "no such block; did you mean " + place + near + "?");
  }
}

/// A contestant may name a file with a policy, such as my_policy.py, instead of a policy.
void take_policy_file(ContestantSpec& c, const std::string& file) {
  const std::optional<host::PolicyListing> found = host::policy_in_file(file);
  if (!found) return;
  c.plugin = file;  // which may be c.policy itself
  c.policy = found->id;
}

ContestantSpec read_contestant(pt::ptree block, const std::string& source) {
  ContestantSpec c;
  c.parameters = take_settings(block, "parameters", source, "contestant.");
  c.settings = take_settings(block, "settings", source, "contestant.");
  refuse_other_blocks(block, source, "contestant.", {"parameters", "settings"});
  OptionTable table;
  table.under("contestant", [&c](OptionTable& t) {
    t.add("name", c.name, {}, "what it is called in results");
    t.add("policy", c.policy, {}, "the exploration policy");
    t.add("plugin", c.plugin, {}, "plugin file to look for the policy in first");
  });
  pt::ptree tree;
  tree.add_child("contestant", block);
  table.read(source, tree);
  if (c.policy.empty()) throw InputError(source, "contestant.policy", "is missing");
  c.plugin = core::beside(source, c.plugin);
  std::error_code error;
  if (const fs::path file = core::beside(source, c.policy); fs::exists(file, error))
    take_policy_file(c, file.string());
  return c;
}

CaveSpec read_cave(const pt::ptree& block, const std::string& source) {
  CaveSpec c;
  OptionTable table;
  table.under("cave", [&c](OptionTable& t) {
    t.add("name", c.name, {}, "what it is called in results");
    t.add("file", c.file, {}, "cave .info file or mesh");
    t.add("start", c.start, {}, "\"x y z [heading_deg]\"; empty: the cave's own");
  });
  pt::ptree tree;
  tree.add_child("cave", block);
  table.read(source, tree);
  if (c.file.empty()) throw InputError(source, "cave.file", "is missing");
  c.file = core::beside(source, c.file);
  return c;
}

const std::string kGoodName = "expected up to 100 letters, digits and _-+=.% without a . or - in front";

bool good_name(const std::string& name) {
  const auto good = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || std::strchr("_-+=.%", c);
  };
  return !name.empty() && name.size() <= 100 && name[0] != '.' && name[0] != '-' &&
         std::all_of(name.begin(), name.end(), good);
}

/// A name suitable for folders: nearest_frontier+horizon=60m.
std::string made_name(const ContestantSpec& c) {
  std::string name = c.policy;
  for (const Settings* some : {&c.parameters, &c.settings})
    for (const auto& [key, value] : *some) {
      name += "+" + key.substr(key.rfind('.') + 1) + "=";
      for (const char v : value)
        if (v != ' ') name += std::isalnum(static_cast<unsigned char>(v)) || v == '.' || v == '-' ? v : '_';
    }
  return name;
}

void refuse_no_file(const Campaign& c, const std::string& key, const std::string& file) {
  if (!fs::exists(file)) throw InputError(c.source, key, file + " is not there");
  if (!fs::is_regular_file(file)) throw InputError(c.source, key, file + " is no file");
}

bool is_of_file(const Campaign& c) { return c.source != Campaign{}.source; }

template <class Named>
void check_names(const Campaign& c, const std::vector<Named>& all, const std::string& what) {
  std::set<std::string> seen;
  for (const Named& n : all) {
    if (!good_name(n.name)) throw InputError(c.source, what + ".name", "\"" + n.name + "\": " + kGoodName);
    if (!seen.insert(n.name).second)
      throw InputError(c.source, what + " " + n.name,
                       "there are two of this name; in a campaign file each can be given a `name`");
  }
}

}  // namespace

ContestantSpec parse_contestant(const std::string& text) {
  ContestantSpec c;
  const auto colon = text.find(':');
  c.policy = text.substr(0, colon);
  if (c.policy.empty())
    throw InputError("command line", text, "expected policy or policy:key=value,key=value");
  take_policy_file(c, c.policy);
  std::istringstream rest(colon == std::string::npos ? "" : text.substr(colon + 1));
  for (std::string item; std::getline(rest, item, ',');) {
    const auto equals = item.find('=');
    if (equals == std::string::npos || equals == 0)
      throw InputError("command line", text, "expected policy:key=value,key=value, got \"" + item + "\"");
    c.parameters.emplace_back(item.substr(0, equals), item.substr(equals + 1));
  }
  return c;
}

CaveSpec parse_cave(const std::string& file) { return {"", file, ""}; }

void complete(Campaign& c) {
  if (c.contestants.empty()) throw InputError(c.source, "contestant", "there is none");
  if (c.caves.empty()) throw InputError(c.source, "cave", "there is none");
  if (c.seeds.empty()) throw InputError(c.source, "seeds", "there are none");
  profile(c.profile);
  if (!good_name(c.name)) throw InputError(c.source, "name", "\"" + c.name + "\": " + kGoodName);
  for (ContestantSpec& k : c.contestants) {
    if (k.name.empty()) k.name = made_name(k);
    if (!k.plugin.empty()) {
      refuse_no_file(c, is_of_file(c) ? "contestant " + k.name + ": plugin" : "--plugin", k.plugin);
      k.plugin = fs::absolute(k.plugin).lexically_normal().string();
    }
    refuse_reserved(c, "contestant " + k.name + ": ", k.settings);
  }
  for (CaveSpec& k : c.caves) {
    if (k.name.empty()) k.name = fs::path(k.file).stem().string();
    refuse_no_file(c, is_of_file(c) ? "cave.file" : "--caves", k.file);
    k.file = fs::absolute(k.file).lexically_normal().string();
  }
  refuse_reserved(c, "settings.", c.settings);
  refuse_reserved(c, "--set ", c.overrides);
  check_names(c, c.contestants, "contestant");
  check_names(c, c.caves, "cave");
}

Campaign read_campaign(const std::string& file) {
  Campaign c;
  c.source = file;
  c.name = fs::path(file).stem().string();
  pt::ptree tree = core::read_info(file);
  c.settings = take_settings(tree, "settings", file, "");
  for (const pt::ptree& block : take_blocks(tree, "contestant"))
    c.contestants.push_back(read_contestant(block, file));
  for (const pt::ptree& block : take_blocks(tree, "cave")) c.caves.push_back(read_cave(block, file));

  refuse_other_blocks(tree, file, "", {"contestant", "cave", "settings"});

  std::int64_t seeds = 0;
  std::string seed_list;
  std::vector<std::string> profile_names;
  for (const Profile& p : profiles()) profile_names.push_back(p.name);
  OptionTable table;
  table.add("name", c.name, {}, "what the campaign is called");
  table.add("mission", c.mission, {}, "mission file with settings that all share");
  table.add("profile", c.profile, profile_names, "set of mission settings");
  table.add("flight_time", c.flight_time_s, "s", 10, 86400, "homing begins at the latest in time for this");
  table.add("trial_timeout", c.trial_timeout_s, "s", 1, 1e7,
            "a trial that takes longer, by the wall clock, hangs");
  table.add("seeds", seeds, 1, kMaxSeeds, "how many: 1, 2, 3 ...");
  table.add("seed_list", seed_list, {}, "the seeds themselves");
  table.add("metric", c.metric, metric_names(), "the figure that the verdict is about");
  for (const auto& [key, value] : core::leaves_of(tree))
    if (key.find('.') != std::string::npos)
      throw InputError(file, key, "is no key of a campaign; settings of the missions go into settings { }");
  table.read(file, tree);
  c.seeds = parse_seeds(file, seeds, seed_list);
  c.mission = core::beside(file, c.mission);
  complete(c);
  return c;
}

}  // namespace karst::campaign
