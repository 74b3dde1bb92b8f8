// Remembers frontiers as they were when a goal was accepted for them. How they have changed since shows
// whether they are still worth flying to.
#pragma once
#include <map>
#include <optional>

#include "core_stack/mapping/frontiers/frontiers.h"

namespace karst::core {

class ChosenFrontiers {
 public:
  void note(const FrontierCluster& cluster) {
    chosen_[cluster.id] = {cluster.cells.size(), cluster.centroid};
  }
  /// False once the vehicle has seen most of the cluster from afar: flying on to it is a waste.
  bool worth_flying_to(const FrontierCluster& cluster) const;
  /// Where it was; nothing if it was never chosen.
  std::optional<Vec3> centroid(std::uint32_t id) const;

 private:
  struct Chosen {
    std::size_t cells;
    Vec3 centroid;
  };
  std::map<std::uint32_t, Chosen> chosen_;
};

}  // namespace karst::core
