// Frontiers: free cells with an unknown face neighbour, kept up to date from the map's changes and grouped
// into clusters of bounded size. If the map is confined to a region, both cells must lie inside.
//
// Space is cut into tiles of a few metres; a cluster is a 26-connected component of frontier cells within one
// tile. Only tiles touched by a change are clustered again. An update's cost therefore depends on the
// changes, not on the map's size, and each cluster is small enough to be one goal.
#pragma once
#include <cstdint>
#include <map>
#include <set>
#include <unordered_map>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core {

struct FrontierOptions {
  double tile_m = 3.2;           // at most 64 cells
  std::int64_t min_cells = 8;    // smaller clusters are noise, not openings
  double neighbourhood_m = 2.0;  // half edge of the box in which free and unknown cells are counted
};
void describe(OptionTable& t, FrontierOptions& o);

struct FrontierCluster {
  std::uint32_t id = 0;  // never reused; kept while the cluster has cells in common with its former self
  std::vector<CellKey> cells;  // sorted
  Vec3 centroid = Vec3::Zero();
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  // bounds of the cells, metres, world frame
  Vec3 normal = Vec3::Zero();  // unit mean direction from free into unknown; zero if undefined
  std::uint32_t unknown_cells = 0, free_cells = 0;  // in the box around the centroid
};

class Frontiers {
 public:
  explicit Frontiers(const FrontierOptions& options);
  /// Updates the clusters after one or more insertions, given all their changes. The clusters and their
  /// counts are then consistent with the current map.
  void update(const VoxelMap& map, std::span<const CellChange> changes);
  /// Clusters of at least min_cells cells, by id.
  const std::map<std::uint32_t, FrontierCluster>& clusters() const { return clusters_; }
  bool is_frontier(const CellKey& k) const;
  std::size_t cell_count() const { return cell_count_; }

 private:
  struct Part {  // a component of any size
    std::uint32_t id = 0;
    std::vector<CellKey> cells;  // sorted
  };
  struct Tile {
    std::vector<std::uint64_t> rows;  // a word per row of cells along z, a bit per cell; rows by x, then y
    std::vector<Part> parts;
  };

  CellKey tile_of(const CellKey& k) const;
  std::size_t row_of(const CellKey& k, const CellKey& tile) const;
  std::uint64_t bit_of(const CellKey& k, const CellKey& tile) const;
  std::vector<CellKey> update_cells(const VoxelMap& map, std::span<const CellChange> changes);
  std::vector<Part> components(const CellKey& tile) const;
  void name(std::vector<Part>& parts, const std::vector<Part>& former);
  void publish(const VoxelMap& map, const Part& part);
  void add_clusters_near(const VoxelMap& map, std::span<const CellChange> changes,
                         std::set<std::uint32_t>& ids) const;

  FrontierOptions options_;
  std::int32_t edge_ = 0;                                 // of a tile, in cells; set with the first map
  std::unordered_map<CellKey, Tile, CellKeyHash> tiles_;  // looked up, never iterated
  std::map<std::uint32_t, FrontierCluster> clusters_;
  std::size_t cell_count_ = 0;
  std::uint32_t last_id_ = 0;
};

}  // namespace karst::core
