#include "sdk/selection/free_space.h"

#include <algorithm>
#include <cmath>

#include "core_stack/common/error.h"
#include "core_stack/mapping/obstacles/obstacle_tree.h"
#include "core_stack/mapping/occupancy/voxel_reader.h"
#include "sdk/evaluation/reachable/reachable.h"
#include "sdk/selection/cell_index.h"

namespace karst::selection {
namespace {

using core::CellKey;
using core::Vec3;
using evaluation::CellSet;

constexpr double kFarM = 500;      // no passage is wider
constexpr double kMaxCells = 4e5;  // so that a description takes seconds

/// Number of cells of `resolution_m` along a coarse cell: as requested, or more if there would be too many
/// cells.
int coarse_edge(const FreeSpaceOptions& options, double resolution_m, std::size_t fine_cells) {
  int n = std::max(1, static_cast<int>(std::lround(options.coarse_m / resolution_m)));
  while (static_cast<double>(fine_cells) / std::pow(n, 3) > kMaxCells) ++n;
  return n;
}

CellKey divided(const CellKey& k, int n) {
  const auto down = [n](int v) { return v >= 0 ? v / n : -((-v + n - 1) / n); };
  return {down(k.x), down(k.y), down(k.z)};
}

/// Coarse cells of `n` fine cells' edge that contain a cell of the set.
CellSet coarsened(const CellSet& fine, int n) {
  const CellKey b = fine.blocks_along();
  CellSet out(divided(fine.first_cell({0, 0, 0}), n), divided(fine.first_cell(b), n));
  fine.for_each([&](const CellKey& k) { out.insert(divided(k, n)); });
  return out;
}

/// The largest 6-connected component; the first one of equal size.
CellSet largest_part(const CellSet& cells) {
  const CellIndex index(cells);
  std::vector<int> part(index.size(), -1);
  std::vector<std::size_t> size;
  for (std::size_t i = 0; i < index.size(); ++i) {
    if (part[i] >= 0) continue;
    std::vector<std::size_t> open{i};
    part[i] = static_cast<int>(size.size());
    size.push_back(0);
    while (!open.empty()) {
      const std::size_t at = open.back();
      open.pop_back();
      ++size.back();
      for (const CellKey& face : core::kFaces)
        if (const std::int32_t j = index.at(index.key(at) + face);
            j >= 0 && part[static_cast<std::size_t>(j)] < 0) {
          part[static_cast<std::size_t>(j)] = part[i];
          open.push_back(static_cast<std::size_t>(j));
        }
    }
  }
  const CellKey b = cells.blocks_along();
  CellSet out(cells.first_cell({0, 0, 0}), cells.first_cell({b.x - 1, b.y - 1, b.z - 1}));
  const auto largest = std::max_element(size.begin(), size.end()) - size.begin();
  for (std::size_t i = 0; i < index.size(); ++i)
    if (part[i] == largest) out.insert(index.key(i));
  return out;
}

/// A surface that passes through a layer of cells leaves half of them free on average, whatever its
/// direction: half a cell is added for each face shared by a free cell and rock.
double volume_with_halves(std::size_t cells, std::size_t faces_to_rock, double resolution_m) {
  return (static_cast<double>(cells) + 0.5 * static_cast<double>(faces_to_rock)) * std::pow(resolution_m, 3);
}

/// A cell that no ray met, although rays met nearly all cells around it, is a gap between rays, not rock.
core::VoxelMap without_gaps(const core::VoxelMap& map) {
  core::MapOptions options;
  options.resolution_m = map.resolution_m();
  core::VoxelMap filled(options);
  core::VoxelReader reader(map);
  std::vector<CellKey> gaps;
  map.for_each_known([&](const CellKey& k, core::Cell c, float log_odds) {
    filled.assign(k, 1, log_odds);
    if (c != core::Cell::free) return;
    for (const CellKey& face : core::kFaces) {
      if (reader.at(k + face) != core::Cell::unknown) continue;
      int free = 0;
      for (const CellKey& other : core::kFaces) free += reader.at(k + face + other) == core::Cell::free;
      if (free >= 4) gaps.push_back(k + face);
    }
  });
  for (const CellKey& k : gaps) filled.assign(k, 1, -1.0f);
  return filled;
}

}  // namespace

FreeSpace free_space_of(const cave::RayScene& scene, const Vec3& start, const FreeSpaceOptions& options,
                        const std::string& name) {
  evaluation::ReachableOptions reach;
  reach.resolution_m = options.resolution_m;
  reach.clearance_m = options.clearance_m;
  const evaluation::Reachable r = evaluation::find_reachable(scene.mesh(), start, reach, name);
  FreeSpace space;
  const int n = coarse_edge(options, options.resolution_m, r.flyable_cells);
  space.resolution_m = n * options.resolution_m;
  space.clearance_m = options.clearance_m;
  space.flyable = coarsened(r.flyable, n);
  std::size_t faces = 0;
  r.reachable.for_each([&](const CellKey& k) {
    for (const CellKey& face : core::kFaces) faces += !r.free.contains(k + face);
  });
  space.volume_m3 = volume_with_halves(r.reachable_cells, faces, options.resolution_m);
  space.distance_to_rock = [scene](const Vec3& p) { return scene.distance_to_rock(p, kFarM); };
  space.range_to_rock = [scene](const Vec3& from, const Vec3& d) {
    return std::min(kFarM, scene.ray_cast(from, d, kFarM));
  };
  return space;
}

FreeSpace free_space_of(const core::VoxelMap& map, const FreeSpaceOptions& options, const std::string& name) {
  const auto filled = std::make_shared<const core::VoxelMap>(without_gaps(map));
  const double edge = map.resolution_m();
  CellKey low{0, 0, 0}, high = low;
  std::size_t free = 0, faces = 0;
  core::VoxelReader reader(*filled);
  filled->for_each_known([&](const CellKey& k, core::Cell c, float) {
    if (c != core::Cell::free) return;
    if (free++ == 0) low = high = k;
    low = {std::min(low.x, k.x), std::min(low.y, k.y), std::min(low.z, k.z)};
    high = {std::max(high.x, k.x), std::max(high.y, k.y), std::max(high.z, k.z)};
    for (const CellKey& face : core::kFaces) faces += reader.at(k + face) == core::Cell::occupied;
  });
  if (free == 0) throw core::InputError(name, "", "the map has no free cell");
  const Vec3 margin = Vec3::Constant(2 * edge);
  const auto rock = std::make_shared<const core::ObstacleTree>(*filled, filled->center_of(low) - margin,
                                                               filled->center_of(high) + margin);
  CellSet flyable(low, high);
  filled->for_each_known([&](const CellKey& k, core::Cell c, float) {
    if (c == core::Cell::free && !rock->any_within(filled->center_of(k), options.clearance_m))
      flyable.insert(k);
  });
  FreeSpace space;
  const int n = coarse_edge(options, edge, flyable.size());
  space.resolution_m = n * edge;
  space.clearance_m = options.clearance_m;
  space.flyable = largest_part(coarsened(flyable, n));
  if (space.flyable.size() == 0)
    throw core::InputError(name, "",
                           "the map holds no place to fly: none is farther from rock and from unknown space "
                           "than the clearance");
  space.volume_m3 = volume_with_halves(free, faces, edge);
  space.distance_to_rock = [rock](const Vec3& p) { return std::min(kFarM, rock->distance(p)); };
  space.range_to_rock = [filled](const Vec3& from, const Vec3& d) {
    const auto end = filled->first_not_free(from, from + kFarM * d);
    // The distance from the centre of the last free cell to that of the first rock cell is half a cell too
    // long on average.
    return end ? std::abs((filled->center_of(*end) - from).dot(d)) : kFarM;
  };
  return space;
}

}  // namespace karst::selection
