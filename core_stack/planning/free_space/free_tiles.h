// The map's free cells as bits, and the questions of clearance answered on them.
//
// What must be kept away from are occupied cells and unknown cells that touch free ones. For a point in a
// free cell that is the same as keeping away from every cell that is not free: from a cell that is not free,
// a step along an axis towards the point leads nearer to it, so the nearest such cell touches a free one.
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "core_stack/planning/free_space/tile_table.h"

namespace karst::core {

using TileBits = std::array<std::uint32_t, kTileRows>;

/// Cells that must be free around a point: rows (dy, dz) of them, |dx| <= half_width. The point is a cell's
/// centre, or shifted from it by half a cell in each axis marked in `shift` (bits x, y, z); with a shift in x
/// the rows reach one cell farther to that side.
class Ball {
 public:
  explicit Ball(double radius_cells, int shift = 0);
  /// A ball around a centre that also holds the cells that a move to one of the 26 neighbours would come
  /// nearer to than the radius: moves between cells that have it free are clear.
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
  /// Those whose centre is clear, as is every move between them. Throws InputError beyond 14 cells.
  explicit ClearanceRule(double clearance_cells);
  /// Those that are so by `search_cells` only, if their centre or a point half a cell from it in some axes is
  /// clear by the whole clearance.
  ClearanceRule(double clearance_cells, double search_cells);
  const Ball& moves() const { return moves_; }
  /// Around the centre and around the points half a cell up from it. None: `moves` alone decides.
  const std::vector<Ball>& points() const { return points_; }
  int extent() const;

 private:
  Ball moves_;
  std::vector<Ball> points_;
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
  void load_near(const VoxelMap& map, const Vec3& p, double radius_m);
  /// Notes a cell's present class.
  void refresh(const VoxelMap& map, const CellKey& k);

  bool at(const CellKey& k) const;
  /// Free cells x to x + 31 of the row (y, z), lowest bit first.
  std::uint32_t row(std::int32_t x, std::int32_t y, std::int32_t z) const;
  /// Cells of tile `t` that a search may use.
  TileBits clear_cells(const TileKey& t, const ClearanceRule& rule) const;

  /// No obstacle's centre is nearer than `clearance_m` to the segment, and it runs through free cells.
  bool segment_clear(const Vec3& a, const Vec3& b, double clearance_m) const;
  bool is_clear(const Vec3& p, double clearance_m) const { return segment_clear(p, p, clearance_m); }
  /// Nearest obstacle's centre, looked for up to `limit_m` (at most 15 cells); without one, the limit.
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
  TileTable table_;
  std::vector<std::unique_ptr<TileBits>> tiles_;
};

}  // namespace karst::core
