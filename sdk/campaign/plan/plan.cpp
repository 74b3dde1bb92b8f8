#include "sdk/campaign/plan/plan.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>
#include <thread>

#include "core_stack/common/error.h"
#include "core_stack/common/info_lines.h"
#include "core_stack/common/json_text.h"
#include "core_stack/common/options.h"
#include "plugins/simulator/cave/cave.h"
#include "sdk/campaign/plan/ask_karst.h"
#include "sdk/campaign/plan/flight_times.h"
#include "sdk/campaign/plan/hash.h"
#include "sdk/campaign/plan/mesh_hash.h"
#include "sdk/campaign/plan/plan_text.h"

namespace karst::campaign {
namespace {

namespace fs = std::filesystem;
namespace pt = boost::property_tree;
using core::InputError;

std::string json_object(const Settings& settings) {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  for (const auto& [key, value] : settings) object[key] = value;
  return core::json_text(object);
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

PlannedContestant planned(const ContestantSpec& who, pt::ptree mission, const fs::path& karst) {
  const std::string policy = mission.get("policy.name", who.policy);  // the policy chosen by `auto`
  PlannedContestant out{who.name, policy, who.plugin, {}, {}, {}, json_object(who.settings), {}};
  out.version = take(mission, "policy", "version").data();
  const std::string karst_version = take(mission, "karst", "version").data();
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
  PlannedCave out{cave.name, cave.file, cave.start, mesh_hash(cave::mesh_of(description)), {}};
  std::string said;
  if (fs::path(description.mesh_path).lexically_normal() != fs::path(cave.file).lexically_normal())
    for (const core::InfoLine& line : core::info_lines(cave.file, core::Includes::refuse))
      said += line.text + "\n";
  out.hash = sha256(out.mesh_hash + "\n" + said);
  return out;
}

/// For a team, until the end of the last robot's flight, which starts last.
double horizon_of(const PlannedContestant& c) {
  const int robots = std::max(1, c.mission.get("team.robots", 1));
  const double stagger_s = robots > 1 ? quantity_in(c.mission, "team.stagger", "s", 0) : 0;
  return (robots - 1) * std::round(stagger_s) + longest_flight_s(c.mission);
}

/// Plans the cave; errors name the campaign's entry.
PlannedCave planned(const CaveSpec& cave, const std::string& source) {
  try {
    return planned(cave);
  } catch (const InputError& e) {
    throw InputError(source, "cave " + cave.name, e.what());
  }
}

/// Calls f(0) to f(n - 1), which wait for processes, as many at once as there are cores. Throws what the
/// first of them in this order throws.
template <class F>
void at_once(std::size_t n, const F& f) {
  std::vector<std::exception_ptr> errors(n);
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < n; i = next++) try {
        f(i);
      } catch (...) {
        errors[i] = std::current_exception();
      }
  };
  {
    std::vector<std::jthread> others;
    for (std::size_t k = 1; k < std::min<std::size_t>(n, std::thread::hardware_concurrency()); ++k)
      others.emplace_back(work);
    work();
  }
  for (const std::exception_ptr& e : errors)
    if (e) std::rethrow_exception(e);
}

/// A contestant is one policy: `auto` must choose the same one in every cave.
void refuse_other_choice(const Campaign& c, const ContestantSpec& who, const PlannedContestant& first,
                         const fs::path& karst, const fs::path& cave_cache) {
  const auto chosen = [](const pt::ptree& mission) {
    return std::pair(mission.get("policy.name", ""), mission.get_child("policy.parameters", {}));
  };
  for (std::size_t i = 1; i < c.caves.size(); ++i)
    if (chosen(resolve(c, who, c.caves[i], karst, cave_cache)) != chosen(first.mission))
      throw InputError(c.source, "contestant " + who.name,
                       "auto chooses otherwise in cave " + c.caves[i].name + " than in " + c.caves[0].name +
                           "; make a campaign of each, or name what is chosen as contestants");
}

/// Figures of each robot of a team (robot_N/metrics.json) that the team as a whole does not have.
constexpr std::array kOfOneVehicle = {
    "completed",     "mean_speed_mps",    "exploring_speed_mps", "standing_share",  "longest_stall_s",
    "depth_m",       "vertical_reach_m",  "min_clearance_m",     "landing_error_m", "battery_left",
    "drift_percent", "heading_error_rad", "tracking_rms_m",      "goals_accepted",  "goals_rejected",
    "overruns",      "surface_imaged"};

/// Least number of robots for which flights have this figure; 1: any flight may have it.
int robots_for(const std::string& metric) {
  if (metric == "robots_landed" || metric == "robots_connected" || metric == "data_at_base_share") return 2;
  int robot = 1;
  return std::sscanf(metric.c_str(), "exploration_time_%d_s", &robot) == 1 ? std::max(2, robot) : 1;
}

}  // namespace

double horizon_of(const std::vector<PlannedContestant>& contestants, const std::string& source) {
  const double horizon_s = contestants.empty() ? 0 : horizon_of(contestants.front());
  for (const PlannedContestant& c : contestants)
    if (const double other_s = horizon_of(c); other_s != horizon_s)
      throw InputError(source, "contestant " + c.name,
                       "may explore for " + core::json_text(nlohmann::json(other_s)) + " s, " +
                           contestants.front().name + " for " + core::json_text(nlohmann::json(horizon_s)) +
                           " s (mission.max_flight_time, simulator.battery_minutes, team.robots, "
                           "team.stagger): figures of such "
                           "flights do not compare; give both the same, or fly a campaign of each");
  return horizon_s;
}

void refuse_figure_of_others(const std::string& metric, const std::vector<PlannedContestant>& contestants,
                             const std::string& source) {
  for (const PlannedContestant& c : contestants) {
    const int robots = c.mission.get("team.robots", 1);
    if (robots > 1 && std::find(kOfOneVehicle.begin(), kOfOneVehicle.end(), metric) != kOfOneVehicle.end())
      throw InputError(source, "metric " + metric,
                       "teams have no such figure, their robots have; contestant " + c.name +
                           " is a team of " + std::to_string(robots) + " (team.robots)");
    if (robots < robots_for(metric))
      throw InputError(source, "metric " + metric,
                       "only teams of " + std::to_string(robots_for(metric)) +
                           " robots and more have it; contestant " + c.name + " has " +
                           std::to_string(robots) + " (team.robots)");
  }
}

Plan make_plan(const Campaign& c, const fs::path& karst, const fs::path& cave_cache) {
  Plan plan;
  plan.name = c.name;
  plan.profile = c.profile;
  plan.trial_timeout_s = c.trial_timeout_s;
  plan.seeds = c.seeds;
  plan.metric = c.metric;
  for (const CaveSpec& cave : c.caves) plan.caves.push_back(planned(cave, c.source));
  // First every cave once: what is found out about it is kept for the contestants after that.
  std::vector<pt::ptree> in_first(c.contestants.size());
  at_once(c.caves.size(), [&](std::size_t i) {
    pt::ptree mission = resolve(c, c.contestants.front(), c.caves[i], karst, cave_cache);
    if (i == 0) in_first.front().swap(mission);
  });
  at_once(c.contestants.size() - 1, [&](std::size_t i) {
    in_first[i + 1] = resolve(c, c.contestants[i + 1], c.caves.front(), karst, cave_cache);
  });
  plan.contestants.resize(c.contestants.size());
  at_once(c.contestants.size(),
          [&](std::size_t i) { plan.contestants[i] = planned(c.contestants[i], in_first[i], karst); });
  for (std::size_t i = 0; i < c.contestants.size(); ++i)
    if (plan.contestants[i].policy != c.contestants[i].policy)
      refuse_other_choice(c, c.contestants[i], plan.contestants[i], karst, cave_cache);
  plan.horizon_s = horizon_of(plan.contestants, c.source);
  refuse_figure_of_others(plan.metric, plan.contestants, c.source);
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

StoreHead head_of(const Plan& plan) {
  StoreHead head{plan.name, definition_of(plan), plan.horizon_s, {}, {}, plan.seeds};
  for (const PlannedContestant& c : plan.contestants)
    head.contestants.push_back({c.name, c.policy, c.version, c.parameters, c.settings});
  for (const PlannedCave& c : plan.caves) head.caves.push_back({c.name, c.file, c.start, "", c.mesh_hash});
  return head;
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
