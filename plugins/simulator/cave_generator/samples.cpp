#include "plugins/simulator/cave_generator/samples.h"

#include <cmath>
#include <thread>

namespace karst::cave {
namespace {

constexpr std::array<Node, 6> kFaces{{{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};

/// Corner i of a cell: bit 0 for x, 1 for y, 2 for z.
Node corner(const Node& cell, int i) { return cell + Node{i & 1, i >> 1 & 1, i >> 2 & 1}; }

/// A corner of the cell to be made hollow, or -1 if its sheets are separate.
int corner_to_open(const Samples& s, const Node& cell) {
  std::array<float, 8> v;
  unsigned hollow = 0;
  for (int i = 0; i < 8; ++i) {
    v[static_cast<std::size_t>(i)] = s.at(corner(cell, i));
    hollow |= (v[static_cast<std::size_t>(i)] < 0 ? 1u : 0u) << i;
  }
  if (hollow == 0 || hollow == 255) return -1;
  const auto softest = [&](unsigned among) {
    int best = -1;
    for (int i = 0; i < 8; ++i)
      if ((among >> i & 1u) &&
          (best < 0 || v[static_cast<std::size_t>(i)] < v[static_cast<std::size_t>(best)]))
        best = i;
    return best;
  };
  constexpr std::array<std::array<int, 4>, 6> faces{
      {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}};
  for (const auto& f : faces) {
    const unsigned one = 1u << f[0] | 1u << f[2], other = 1u << f[1] | 1u << f[3];
    if ((hollow & (one | other)) == one) return softest(other);
    if ((hollow & (one | other)) == other) return softest(one);
  }
  for (int i = 0; i < 4; ++i) {
    const unsigned pair = 1u << i | 1u << (7 - i);
    if (hollow == pair || (~hollow & 255u) == pair) return softest(~hollow & 255u);
  }
  return -1;
}

}  // namespace

Samples::Samples(const CaveField& field, double grid_m)
    : grid_m_(grid_m), low_(field.low()), count_(field.cubes_along()) {
  blocks_.resize(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2]);
  const auto fill = [&](std::size_t first, std::size_t stride) {
    for (std::size_t i = first; i < blocks_.size(); i += stride) {
      const Node c = block_corner(i);
      const CaveField::Cube& cube = field.cube(c.x >> 3, c.y >> 3, c.z >> 3);
      if (!cube.any()) continue;
      std::vector<float> values(kEdge * kEdge * kEdge);
      constexpr int kPart = 4;  // eighths of a block far from the surface are decided by one value
      for (int part = 0; part < 8; ++part) {
        const Node origin = c + Node{kPart * (part & 1), kPart * (part >> 1 & 1), kPart * (part >> 2 & 1)};
        const double half_m = 0.5 * (kPart - 1) * grid_m;
        const double all = field.value_around(position(origin) + core::Vec3::Constant(half_m),
                                              half_m * std::sqrt(3.0), cube);
        for (int k = 0; k < kPart * kPart * kPart; ++k) {
          const Node n = origin + Node{k % kPart, k / kPart % kPart, k / (kPart * kPart)};
          values[inside(n)] = static_cast<float>(all != 0 ? all : field.value(position(n), cube));
        }
      }
      blocks_[i] = std::move(values);
    }
  };
  {
    std::jthread other(fill, std::size_t{1}, std::size_t{2});
    fill(0, 2);
  }
  // A missing block is rock, so the hollow must never touch one.
  std::vector<Node> border;
  for_each([&](const Node& n) {
    if (!hollow(n)) return;
    for (int i = 0; i < 27; ++i)
      if (!has_block(n + Node{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1})) {
        border.push_back(n);
        return;
      }
  });
  for (const Node& n : border) set(n, kRock);
}

Node Samples::block_corner(std::size_t i) const {
  const auto nx = static_cast<std::size_t>(count_[0]), ny = static_cast<std::size_t>(count_[1]);
  return {static_cast<std::int32_t>(i % nx) * kEdge, static_cast<std::int32_t>(i / nx % ny) * kEdge,
          static_cast<std::int32_t>(i / (nx * ny)) * kEdge};
}

Node Samples::nearest(const core::Vec3& p) const {
  const core::Vec3 n = ((p - low_) / grid_m_).array().round();
  return {static_cast<std::int32_t>(n.x()), static_cast<std::int32_t>(n.y()),
          static_cast<std::int32_t>(n.z())};
}

void separate_sheets(Samples& s) {
  const float opened = static_cast<float>(-0.1 * s.grid_m());
  std::vector<Node> cells;
  s.for_each([&](const Node& n) {
    if (corner_to_open(s, n) >= 0) cells.push_back(n);
  });
  while (!cells.empty()) {
    const Node cell = cells.back();
    cells.pop_back();
    const int i = corner_to_open(s, cell);
    if (i < 0) continue;
    const Node n = corner(cell, i);
    s.set(n, opened);
    for (int k = 0; k < 8; ++k) cells.push_back(n + Node{-(k & 1), -(k >> 1 & 1), -(k >> 2 & 1)});
  }
}

void keep_one_cave(Samples& s, const core::Vec3& start) {
  const auto mark = [&s](std::vector<std::vector<bool>>& marks, std::vector<Node> queue,
                         const auto& belongs) {
    while (!queue.empty()) {
      const Node n = queue.back();
      queue.pop_back();
      if (!s.has_block(n) || !belongs(n)) continue;
      std::vector<bool>& block = marks[s.block_of(n)];
      if (block.empty()) block.resize(Samples::kEdge * Samples::kEdge * Samples::kEdge);
      if (block[Samples::inside(n)]) continue;
      block[Samples::inside(n)] = true;
      for (const Node& f : kFaces) queue.push_back(n + f);
    }
  };
  std::vector<std::vector<bool>> cave(s.block_count()), rock(s.block_count());
  mark(cave, {s.nearest(start)}, [&s](const Node& n) { return s.hollow(n); });
  std::vector<Node> outer;
  s.for_each([&](const Node& n) {
    for (const Node& f : kFaces)
      if (!s.has_block(n + f)) outer.push_back(n);
  });
  mark(rock, std::move(outer), [&s](const Node& n) { return !s.hollow(n); });
  const auto marked = [&](const std::vector<std::vector<bool>>& marks, const Node& n) {
    const std::vector<bool>& block = marks[s.block_of(n)];
    return !block.empty() && block[Samples::inside(n)];
  };
  std::vector<Node> fill, open;
  s.for_each([&](const Node& n) {
    if (s.hollow(n) && !marked(cave, n)) fill.push_back(n);
    if (!s.hollow(n) && !marked(rock, n)) open.push_back(n);
  });
  for (const Node& n : fill) s.set(n, Samples::kRock);
  for (const Node& n : open) s.set(n, -Samples::kRock);
}

double hollow_volume_m3(const Samples& s) {
  std::size_t n = 0;
  s.for_each([&](const Node& node) { n += s.hollow(node) ? 1u : 0u; });
  return static_cast<double>(n) * s.grid_m() * s.grid_m() * s.grid_m();
}

}  // namespace karst::cave
