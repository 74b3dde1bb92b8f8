// The map's free cells as bits, and the questions of clearance answered on them.
//
// What must be kept away from are occupied cells and unknown cells that touch free ones. For a point in a
// free cell that is the same as keeping away from every cell that is not free: from a cell that is not free,
// a step along an axis towards the point leads nearer to it, so the nearest such cell touches a free one.
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "core_stack/planning/tile_table.h"

namespace karst::core {

using TileBits = std::array<std::uint32_t, kTileRows>;

/// Cells that must be free around a clear cell: |dx| <= half_width in each row (dy, dz).
class Ball {
 public:
  /// Besides the cells nearer than the radius it holds those that a move to one of the 26 neighbours would
  /// come nearer to than that, so that moves between clear cells are clear. Throws InputError beyond 16
  /// cells.
  explicit Ball(double radius_cells);
  struct Row {
    int dy, dz, half_width;
  };
  const std::vector<Row>& rows() const { return rows_; }
  int reach() const { return reach_; }

 private:
  std::vector<Row> rows_;
  int reach_ = 0;
};

struct NearestObstacle {
  double distance_m;
  Vec3 center;  // of the obstacle's cell; not set if there is none within the limit
};

class FreeTiles {
 public:
  explicit FreeTiles(double resolution_m) : resolution_m_(resolution_m) {}

  /// Reads the tiles that touch the closed box of cells and have not been read yet. What was never read
  /// counts as unknown.
  void load(const VoxelMap& map, const CellKey& low, const CellKey& high);
  void load_near(const VoxelMap& map, const Vec3& p, double reach_m);
  /// Notes a cell's present class.
  void refresh(const VoxelMap& map, const CellKey& k);

  bool at(const CellKey& k) const;
  /// Free cells x to x + 31 of the row (y, z), lowest bit first.
  std::uint32_t row(std::int32_t x, std::int32_t y, std::int32_t z) const;
  /// Cells of tile `t` around which the whole ball is free.
  TileBits clear_cells(const TileKey& t, const Ball& ball) const;

  /// No obstacle's centre is nearer than `clearance_m` to the segment, and it runs through free cells.
  bool segment_clear(const Vec3& a, const Vec3& b, double clearance_m) const;
  bool is_clear(const Vec3& p, double clearance_m) const { return segment_clear(p, p, clearance_m); }
  /// Nearest obstacle's centre, looked for up to `limit_m` (at most 15 cells); without one, the limit.
  NearestObstacle nearest(const Vec3& p, double limit_m) const;

  double resolution_m() const { return resolution_m_; }
  CellKey key_of(const Vec3& p) const;
  Vec3 center_of(const CellKey& k) const;

 private:
  bool row_free(std::int32_t x_low, std::int32_t x_high, std::int32_t y, std::int32_t z) const;
  const TileBits& bits(const TileKey& t) const;

  double resolution_m_;
  TileTable table_;
  std::vector<std::unique_ptr<TileBits>> tiles_;
};

}  // namespace karst::core
