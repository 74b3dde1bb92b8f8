#include "sdk/selection/goal.h"

#include <algorithm>
#include <array>
#include <vector>

#include "core_stack/common/error.h"
#include "core_stack/common/options.h"
#include "sdk/evaluation/metrics/metric_definitions.h"

namespace karst::selection {
namespace {

constexpr std::array kGoals{
    Goal{"soonest", "coverage_auc", "cover the cave soon"},
    Goal{"deepest", "depth_m", "reach far from the start"},
    Goal{"walls", "surface_imaged", "take pictures of the walls"},
    Goal{"objects", "objects_found", "find objects"},
    Goal{"energy", "volume_per_wh_m3", "explore much for little energy"},
};

}  // namespace

std::span<const Goal> goals() { return kGoals; }

std::string metric_for(const std::string& name, const std::string& source) {
  const auto goal = std::find_if(kGoals.begin(), kGoals.end(), [&](const Goal& g) { return g.name == name; });
  if (goal != kGoals.end()) return std::string(goal->metric);
  if (evaluation::metric_index(name) >= 0) return name;
  std::vector<std::string> names;
  std::string all;
  for (const Goal& g : kGoals) {
    names.emplace_back(g.name);
    all += (all.empty() ? "" : ", ") + names.back();
  }
  const std::string near = core::nearest_name(name, names);
  throw core::InputError(source, name,
                         "is no goal and no figure" +
                             (near.empty() ? "; the goals are " + all : "; did you mean " + near + "?"));
}

std::string goal_of(const std::string& metric) {
  const auto goal =
      std::find_if(kGoals.begin(), kGoals.end(), [&](const Goal& g) { return g.metric == metric; });
  return goal == kGoals.end() ? "" : std::string(goal->name);
}

}  // namespace karst::selection
