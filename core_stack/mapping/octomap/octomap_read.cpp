#include "core_stack/mapping/octomap/octomap_io.h"
#include "core_stack/mapping/octomap/octomap_leaves.h"

namespace karst::core {

VoxelMap read_octomap(const std::string& path) {
  const MapLeaves read = read_leaves(path);
  MapOptions options;
  options.resolution_m = read.resolution_m;
  VoxelMap map(options);
  for (const MapLeaf& l : read.leaves) map.assign(l.low, l.edge, l.log_odds);
  return map;
}

}  // namespace karst::core
