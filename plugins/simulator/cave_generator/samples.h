// The field's values at the nodes of a regular grid, kept only where the cave is.
#pragma once
#include "plugins/simulator/cave_generator/field.h"

namespace karst::cave {

struct Node {
  std::int32_t x = 0, y = 0, z = 0;
  Node operator+(const Node& o) const { return {x + o.x, y + o.y, z + o.z}; }
  bool operator==(const Node&) const = default;
};

/// Nodes by blocks of 8x8x8, one for each cube of the field.
class Samples {
 public:
  static constexpr int kEdge = 8;
  static constexpr float kRock = 1;  // value of all nodes of a missing block
  using Block = std::array<float, kEdge * kEdge * kEdge>;

  /// The field's cubes must be kEdge * grid_m wide.
  Samples(const CaveField& field, double grid_m);

  double grid_m() const { return grid_m_; }
  core::Vec3 position(const Node& n) const { return low_ + grid_m_ * core::Vec3(n.x, n.y, n.z); }
  Node nearest(const core::Vec3& p) const;

  float at(const Node& n) const {
    const std::size_t i = block_of(n);
    return i == kNone || blocks_[i].empty() ? kRock : blocks_[i][inside(n)];
  }
  bool hollow(const Node& n) const { return at(n) < 0; }
  /// The node must be in an existing block.
  void set(const Node& n, float value) { blocks_[block_of(n)][inside(n)] = value; }
  bool has_block(const Node& n) const {
    const std::size_t i = block_of(n);
    return i != kNone && !blocks_[i].empty();
  }

  std::size_t block_count() const { return blocks_.size(); }
  bool block_empty(std::size_t i) const { return blocks_[i].empty(); }
  Node block_corner(std::size_t i) const;
  static constexpr std::size_t kNone = ~std::size_t{0};
  std::size_t block_of(const Node& n) const {
    const std::int32_t x = n.x >> 3, y = n.y >> 3, z = n.z >> 3;
    if (x < 0 || y < 0 || z < 0 || x >= count_[0] || y >= count_[1] || z >= count_[2]) return kNone;
    return (static_cast<std::size_t>(z) * count_[1] + y) * count_[0] + x;
  }
  static std::size_t inside(const Node& n) {
    return static_cast<std::size_t>(((n.z & 7) * kEdge + (n.y & 7)) * kEdge + (n.x & 7));
  }

  /// Visits all nodes of the existing blocks, in a fixed order.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      if (blocks_[i].empty()) continue;
      const Node c = block_corner(i);
      for (int z = 0; z < kEdge; ++z)
        for (int y = 0; y < kEdge; ++y)
          for (int x = 0; x < kEdge; ++x) visit(c + Node{x, y, z});
    }
  }

 private:
  double grid_m_;
  core::Vec3 low_;
  std::array<std::int32_t, 3> count_;
  std::vector<std::vector<float>> blocks_;
};

/// Widens the hollow by single nodes until rock and hollow never meet in an edge or a corner only, so that
/// no two sheets of the surface between them touch (a well-composed set: Latecki, 1997).
void separate_sheets(Samples& s);

/// Fills hollows that are not connected to the start's, and removes rock that hangs in the air.
void keep_one_cave(Samples& s, const core::Vec3& start);

/// Volume of the hollow nodes.
double hollow_volume_m3(const Samples& s);

}  // namespace karst::cave
