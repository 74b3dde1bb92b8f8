// The map's free cells as bitmaps, and clearance queries on them. If the map is confined to a region, cells
// outside of it count as obstacles here, and so in every path.
//
// Obstacles are occupied cells, and unknown cells that touch free ones. For a point in a free cell, clearance
// from these equals clearance from all cells that are not free: a step along an axis from such a cell towards
// the point leads nearer to it, so the nearest cell that is not free touches a free one.
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "core_stack/planning/free_space/tile_table.h"

namespace karst::core {

using TileBits = std::array<std::uint32_t, kTileRows>;

/// The cells that must be free around a point, as rows (dy, dz) with |dx| <= half_width. The point is a
/// cell's centre, shifted by half a cell along each axis marked in `shift` (bits x, y, z). With a shift in x
/// the rows extend one cell farther to that side.
class Ball {
 public:
  explicit Ball(double radius_cells, int shift = 0);
  /// A ball around a cell's centre that also covers the cells within the radius of any move to one of the 26
  /// neighbours: moves between cells whose ball is free are clear.
  static Ball with_moves(double radius_cells);
  struct Row {
    int dy, dz, half_width;
  };
  const std::vector<Row>& rows() const { return rows_; }
  int shift() const { return shift_; }
  int extent() const { return extent_; }

 private:
  template <class Holds>
  void fill(double radius_cells, Holds&& holds);

  std::vector<Row> rows_;
  int shift_, extent_ = 0;
};

/// Which cells a search may use.
class ClearanceRule {
 public:
  /// Cells whose centre is clear, as is every move between them. Throws InputError beyond 14 cells.
  explicit ClearanceRule(double clearance_cells);
  /// Cells clear by `search_cells` only, provided that their centre or a point half a cell from it along some
  /// axes has the whole clearance.
  ClearanceRule(double clearance_cells, double search_cells);
  const Ball& moves() const { return moves_; }
  /// Balls around the centre and the points half a cell up from it. Empty: `moves` alone decides.
  const std::vector<Ball>& points() const { return points_; }
  int extent() const;

 private:
  Ball moves_;
  std::vector<Ball> points_;
};

struct NearestObstacle {
  double distance_m;
  Vec3 center;  // of the obstacle cell; not set if there is none within the limit
};

/// Whether the map's region limits the free cells.
enum class Confined { yes, no };

class FreeTiles {
 public:
  explicit FreeTiles(double resolution_m, Confined confined = Confined::yes)
      : resolution_m_(resolution_m), confined_(confined == Confined::yes) {}

  /// Reads the tiles that touch the closed box of cells and have not been read yet. Cells never read count as
  /// unknown.
  void load(const VoxelMap& map, const CellKey& low, const CellKey& high);
  void load_near(const VoxelMap& map, const Vec3& p, double radius_m);
  /// Updates a cell to its current class.
  void refresh(const VoxelMap& map, const CellKey& k);

  bool at(const CellKey& k) const;
  /// Free cells x to x + 31 of the row (y, z), lowest bit first.
  std::uint32_t row(std::int32_t x, std::int32_t y, std::int32_t z) const;
  /// Cells of tile `t` that a search may use.
  TileBits clear_cells(const TileKey& t, const ClearanceRule& rule) const;

  /// Whether the segment runs through free cells, with no obstacle's centre within `clearance_m`.
  bool segment_clear(const Vec3& a, const Vec3& b, double clearance_m) const;
  bool is_clear(const Vec3& p, double clearance_m) const { return segment_clear(p, p, clearance_m); }
  /// The nearest obstacle's centre within `limit_m` (at most 15 cells); the limit if there is none.
  NearestObstacle nearest(const Vec3& p, double limit_m) const;

  double resolution_m() const { return resolution_m_; }
  CellKey key_of(const Vec3& p) const;
  Vec3 center_of(const CellKey& k) const;

 private:
  struct LastTile;
  bool row_free(std::int32_t x_low, std::int32_t x_high, std::int32_t y, std::int32_t z,
                LastTile& last) const;
  const TileBits& bits(const TileKey& t) const;

  double resolution_m_;
  bool confined_;
  TileTable table_;
  std::vector<std::unique_ptr<TileBits>> tiles_;
};

}  // namespace karst::core
