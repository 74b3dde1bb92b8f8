#include "sdk/map_merge/merge_maps.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace karst::map_merge {
namespace {

using core::Cell;
using core::CellKey;
using core::MapOptions;
using core::Pose;
using core::VoxelMap;

}  // namespace

void add_map(VoxelMap& target, const VoxelMap& source, const Pose& T_target_source,
             const MapOptions& options) {
  if (std::abs(target.resolution_m() / source.resolution_m() - 1) > 0.01)
    throw std::invalid_argument("maps whose cells differ in size cannot be added");
  const auto logit = [](double p) { return static_cast<float>(std::log(p / (1 - p))); };
  const float low = logit(options.min_probability), high = logit(options.max_probability);
  const Pose T_source_target = T_target_source.inverse();
  source.for_each_known([&](const CellKey& k, Cell, float log_odds) {
    // The source cells whose centres may lie in this cell are at most one away from its transformed centre;
    // each centre lies in one cell only, so nothing is added twice.
    const CellKey near = target.key_of(T_target_source * source.center_of(k));
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const CellKey cell = near + CellKey{dx, dy, dz};
          if (source.key_of(T_source_target * target.center_of(cell)) != k) continue;
          const float sum = target.log_odds(cell).value_or(0.0f) + log_odds;
          target.assign(cell, 1, std::clamp(sum, low, high));
        }
  });
}

}  // namespace karst::map_merge
