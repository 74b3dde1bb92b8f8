#include "core_stack/mission/decision/chosen_frontiers.h"

namespace karst::core {
namespace {

/// A cluster that has lost this fraction of its cells has been seen.
constexpr double kSeenFraction = 0.75;

}  // namespace

bool ChosenFrontiers::worth_flying_to(const FrontierCluster& cluster) const {
  const auto chosen = chosen_.find(cluster.id);
  return chosen == chosen_.end() || static_cast<double>(cluster.cells.size()) >=
                                        (1 - kSeenFraction) * static_cast<double>(chosen->second.cells);
}

std::optional<Vec3> ChosenFrontiers::centroid(std::uint32_t id) const {
  const auto chosen = chosen_.find(id);
  if (chosen == chosen_.end()) return std::nullopt;
  return chosen->second.centroid;
}

}  // namespace karst::core
