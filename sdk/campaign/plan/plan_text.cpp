#include "sdk/campaign/plan/plan_text.h"

#include <boost/property_tree/info_parser.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core_stack/common/error.h"
#include "core_stack/common/info_reader.h"
#include "core_stack/common/json_text.h"
#include "core_stack/common/options.h"
#include "sdk/campaign/plan/plan.h"

namespace karst::campaign {

namespace pt = boost::property_tree;
using core::InputError;
using nlohmann::json;

namespace {

pt::ptree tree_of(const std::string& definition, const std::string& source) {
  return core::parse_info(definition, source + ": campaign.definition");
}

}  // namespace

std::string info_text(const pt::ptree& tree) {
  std::ostringstream out;
  pt::write_info(out, tree);
  return out.str();
}

std::string seeds_text(const std::vector<std::int64_t>& seeds) {
  std::string text;
  for (const std::int64_t s : seeds) text += (text.empty() ? "" : " ") + std::to_string(s);
  return text;
}

std::string definition_of(const Plan& plan) {
  pt::ptree tree;
  tree.put("name", plan.name);
  tree.put("profile", plan.profile);
  tree.put("horizon_s", core::json_text(json(plan.horizon_s)));
  tree.put("trial_timeout_s", core::json_text(json(plan.trial_timeout_s)));
  tree.put("seeds", seeds_text(plan.seeds));
  tree.put("metric", plan.metric);
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
  const pt::ptree tree = tree_of(definition, source);
  try {
    plan.name = tree.get<std::string>("name");
    plan.profile = tree.get<std::string>("profile");
    plan.horizon_s = tree.get<double>("horizon_s");
    plan.trial_timeout_s = tree.get<double>("trial_timeout_s");
    plan.metric = tree.get("metric", plan.metric);
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

}  // namespace karst::campaign
