// The occupancy map: cubic cells, free, occupied or unknown, with OctoMap's Bayesian model. World frame.
//
// The working copy is a hash table of 8x8x8 blocks of log-odds, an order of magnitude faster to update and
// query than a tree; octomap::OcTree is created from it for storage and for other tools (octomap_io.h). Cell
// boundaries are OctoMap's: cell k covers [k, k+1) * resolution in each axis. So is the world's size: keys
// from -32768 to 32767 (6.5 km at 0.2 m). Cells beyond are unknown and stay so.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core_stack/common/geometry.h"
#include "core_stack/common/options.h"
#include "core_stack/mapping/occupancy/rays.h"

namespace karst::core {

class FlightRegion;

enum class Cell : std::uint8_t { unknown = 0, free = 1, occupied = 2 };

struct CellKey {
  std::int32_t x = 0, y = 0, z = 0;
  auto operator<=>(const CellKey&) const = default;
  CellKey operator+(const CellKey& o) const { return {x + o.x, y + o.y, z + o.z}; }
};
struct CellKeyHash {
  std::size_t operator()(const CellKey& k) const;
};

struct MapOptions {
  double resolution_m = 0.2;
  // OctoMap's defaults are 0.7 and 0.4: two misses outweigh a hit. Grazing rays then clear a spike of rock,
  // and this vehicle flies close to rock; here a hit weighs as much as five misses.
  double hit_probability = 0.75;
  double miss_probability = 0.45;
  double min_probability = 0.12;
  double max_probability = 0.97;
};
void describe(OptionTable& t, MapOptions& o);

/// A cell whose class changed, with its previous class.
struct CellChange {
  CellKey key;
  Cell before, after;
};

/// A cell and the log-odds that it is occupied.
struct CellValue {
  CellKey key;
  float log_odds;
};

class VoxelMap {
 public:
  explicit VoxelMap(const MapOptions& options);
  ~VoxelMap();
  VoxelMap(VoxelMap&&) noexcept;
  VoxelMap& operator=(VoxelMap&&) noexcept;

  double resolution_m() const;
  CellKey key_of(const Vec3& p) const;
  Vec3 center_of(const CellKey& k) const;

  Cell at(const CellKey& k) const;  // a few nanoseconds if queries are coherent; allows concurrent readers
  Cell at(const Vec3& p) const { return at(key_of(p)); }
  std::optional<float> log_odds(const CellKey& k) const;

  /// Updates the map with one scan (world frame): a cell hit by any ray is hit once, a cell only passed is
  /// missed once (the semantics of OctoMap's insertPointCloud). Of the rays that start in one cell and end in
  /// one half cell (half a cell's edge in each axis) only the first is cast. The end cell of a ray without a
  /// hit is not updated. Rays that are not finite or leave the world are ignored. Returns the cells whose
  /// class changed, sorted by key.
  std::vector<CellChange> insert(std::span<const Ray> rays);
  /// Declares a ball free (the launch site, which the operator guarantees to be free); known cells keep their
  /// value.
  std::vector<CellChange> declare_free(const Vec3& center, double radius_m);
  /// Gives cells that are unknown these values, as of an earlier map; known cells keep theirs. Cells outside
  /// the world are ignored. Returns the cells whose class changed, sorted by key.
  std::vector<CellChange> fill_unknown(std::span<const CellValue> cells);

  /// Gives every cell of a cube the same log-odds, clamped to the storable range (+-7.9); for maps read from
  /// storage or drawn by hand. Cells of the cube outside the world are ignored.
  void assign(const CellKey& low, std::int32_t edge_cells, float log_odds);

  /// Confines the vehicle to a region from now on; null: everywhere. Cells keep their class, and the map
  /// grows beyond the region. Only what asks where it may fly takes note.
  void confine(std::shared_ptr<const FlightRegion> region);
  const FlightRegion* region() const;  // null: everywhere
  /// Whether a path may count the cell as free: it is free, and its centre lies in the region with its
  /// margin.
  bool may_fly(const CellKey& k) const;

  std::size_t free_cells() const;
  std::size_t occupied_cells() const;
  double free_volume_m3() const;

  /// Number of the last write (insert or declare_free) that changed the class of a cell within the blocks
  /// that touch the ball. While this number stays the same, the surroundings are unchanged.
  std::uint64_t revision_near(const Vec3& center, double radius_m) const;
  std::uint64_t revision() const;  // number of writes so far

  /// First cell on the segment that is not free, if any (visits every cell the segment passes).
  std::optional<CellKey> first_not_free(const Vec3& from, const Vec3& to) const;
  /// First occupied cell on the segment, if any; free and unknown cells are transparent.
  std::optional<CellKey> first_occupied(const Vec3& from, const Vec3& to) const;

  /// All known cells in a deterministic order (blocks sorted by key, then x fastest).
  void for_each_known(const std::function<void(const CellKey&, Cell, float log_odds)>& f) const;
  /// Known cells within the closed box of keys, same order.
  void for_each_in_box(const CellKey& low, const CellKey& high,
                       const std::function<void(const CellKey&, Cell)>& f) const;

 private:
  friend class VoxelReader;  // voxel_reader.h: faster reading of neighbouring cells
  struct Storage;
  std::unique_ptr<Storage> storage_;
};

/// Visits the cells of a segment in order, both ends' cells included; stops when `visit` returns false.
/// Amanatides and Woo, 1987. Visits nothing if an end is not finite, or 2^20 cells or more from the
/// origin.
void traverse(const Vec3& from, const Vec3& to, double resolution_m,
              const std::function<bool(const CellKey&)>& visit);

}  // namespace karst::core
