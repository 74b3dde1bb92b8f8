// The field's values at the nodes of a regular grid, kept only where the cave is.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "plugins/simulator/cave_generator/field.h"

namespace karst::cave {

struct Node {
  std::int32_t x = 0, y = 0, z = 0;
  Node operator+(const Node& o) const { return {x + o.x, y + o.y, z + o.z}; }
  bool operator==(const Node&) const = default;
};

/// Writes a signed distance field, negative in free space, into the nodes of a block (x fastest, then y and
/// z). The block has that number and its first node lies at the corner. Called from two threads at once.
using FillBlock = std::function<void(std::size_t block, const core::Vec3& corner, float* values)>;

/// Nodes by blocks of 8x8x8. Only blocks near the cave exist; all others are rock. They are found through a
/// coarse grid of tables, each for 16x16x16 blocks: a cave of tens of kilometres leaves most tables away.
class Samples {
 public:
  static constexpr int kEdge = 8;
  static constexpr float kRock = 1;  // value of all nodes of a missing block

  /// A block for each cube of the field that holds anything; the cubes must be kEdge * grid_m wide.
  Samples(const CaveField& field, double grid_m);

  /// `corners`: the first nodes of the blocks, ascending by z, y and x, all of them multiples of kEdge and
  /// not negative. Node 0 0 0 lies at `low`. Throws std::length_error if they lie so far apart that the
  /// coarse grid has more than kMostTables cells.
  Samples(const core::Vec3& low, double grid_m, std::vector<Node> corners, const FillBlock& fill);
  static constexpr std::size_t kMostTables = std::size_t{1} << 27;

  double grid_m() const { return grid_m_; }
  core::Vec3 position(const Node& n) const { return low_ + grid_m_ * core::Vec3(n.x, n.y, n.z); }
  Node nearest(const core::Vec3& p) const;

  float at(const Node& n) const {
    const std::size_t i = block_of(n);
    return i == kNone ? kRock : values_[i * kNodes + inside(n)];
  }
  bool hollow(const Node& n) const { return at(n) < 0; }
  /// The node must be in an existing block.
  void set(const Node& n, float value) { values_[block_of(n) * kNodes + inside(n)] = value; }
  bool has_block(const Node& n) const { return block_of(n) != kNone; }

  std::size_t block_count() const { return corners_.size(); }
  const Node& block_corner(std::size_t i) const { return corners_[i]; }
  static constexpr std::size_t kNone = ~std::size_t{0};
  /// kNone if there is no such block.
  std::size_t block_of(const Node& n) const {
    const std::int32_t x = n.x >> 7, y = n.y >> 7, z = n.z >> 7;
    if (x < 0 || y < 0 || z < 0 || x >= tables_[0] || y >= tables_[1] || z >= tables_[2]) return kNone;
    const std::uint32_t table = table_of_[(static_cast<std::size_t>(z) * tables_[1] + y) * tables_[0] + x];
    if (table == kMissing) return kNone;
    const auto at = static_cast<std::size_t>(((n.z >> 3 & 15) * 16 + (n.y >> 3 & 15)) * 16 + (n.x >> 3 & 15));
    const std::uint32_t block = blocks_of_[table * kTable + at];
    return block == kMissing ? kNone : block;
  }
  static std::size_t inside(const Node& n) {
    return static_cast<std::size_t>(((n.z & 7) * kEdge + (n.y & 7)) * kEdge + (n.x & 7));
  }

  /// Visits all nodes of the existing blocks, in a fixed order.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (const Node& c : corners_)
      for (int z = 0; z < kEdge; ++z)
        for (int y = 0; y < kEdge; ++y)
          for (int x = 0; x < kEdge; ++x) visit(c + Node{x, y, z});
  }

 private:
  static constexpr std::uint32_t kMissing = ~std::uint32_t{0};
  static constexpr std::size_t kNodes = kEdge * kEdge * kEdge, kTable = 16 * 16 * 16;

  void index_blocks();
  void sample(const FillBlock& fill);

  double grid_m_;
  core::Vec3 low_;
  std::vector<Node> corners_;
  std::vector<float> values_;             // block by block
  std::array<std::int32_t, 3> tables_{};  // along each axis
  std::vector<std::uint32_t> table_of_;   // number of the table, or kMissing
  std::vector<std::uint32_t> blocks_of_;  // table by table: number of the block, or kMissing
};

/// Widens the hollow by single nodes until rock and hollow never meet in an edge or a corner only, so that
/// no two sheets of the surface between them touch (a well-composed set: Latecki, 1997).
void separate_sheets(Samples& s);

/// Fills hollows that are not connected to one of the places', and removes rock that hangs in the air.
void keep_caves(Samples& s, std::span<const core::Vec3> places);
/// The same for a cave with one start.
void keep_one_cave(Samples& s, const core::Vec3& start);

/// Volume of the hollow nodes.
double hollow_volume_m3(const Samples& s);

}  // namespace karst::cave
