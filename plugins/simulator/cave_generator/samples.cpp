#include "plugins/simulator/cave_generator/samples.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <thread>
#include <utility>

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

std::vector<Node> corners_of(const CaveField& field) {
  const auto [nx, ny, nz] = field.cubes_along();
  std::vector<Node> corners;
  for (std::int32_t z = 0; z < nz; ++z)
    for (std::int32_t y = 0; y < ny; ++y)
      for (std::int32_t x = 0; x < nx; ++x)
        if (field.cube(x, y, z).any())
          corners.push_back({x * Samples::kEdge, y * Samples::kEdge, z * Samples::kEdge});
  return corners;
}

}  // namespace

Samples::Samples(const CaveField& field, double grid_m)
    : grid_m_(grid_m), low_(field.low()), corners_(corners_of(field)) {
  index_blocks();
  sample([&](std::size_t block, const core::Vec3&, float* values) {
    const Node& c = corners_[block];
    const CaveField::Cube& cube = field.cube(c.x >> 3, c.y >> 3, c.z >> 3);
    constexpr int kPart = 4;  // eighths of a block far from the surface are decided by one value
    for (int part = 0; part < 8; ++part) {
      const Node origin{kPart * (part & 1), kPart * (part >> 1 & 1), kPart * (part >> 2 & 1)};
      const auto place = [&](const Node& n) { return position(c + n); };
      const double half_m = 0.5 * (kPart - 1) * grid_m_;
      const double all =
          field.value_around(place(origin) + core::Vec3::Constant(half_m), half_m * std::sqrt(3.0), cube);
      for (int k = 0; k < kPart * kPart * kPart; ++k) {
        const Node n = origin + Node{k % kPart, k / kPart % kPart, k / (kPart * kPart)};
        values[inside(n)] = static_cast<float>(all != 0 ? all : field.value(place(n), cube));
      }
    }
  });
}

Samples::Samples(const core::Vec3& low, double grid_m, std::vector<Node> corners, const FillBlock& fill)
    : grid_m_(grid_m), low_(low), corners_(std::move(corners)) {
  index_blocks();
  sample(fill);
}

void Samples::index_blocks() {
  for (const Node& c : corners_)
    tables_ = {std::max(tables_[0], (c.x >> 7) + 1), std::max(tables_[1], (c.y >> 7) + 1),
               std::max(tables_[2], (c.z >> 7) + 1)};
  const std::size_t layer = static_cast<std::size_t>(tables_[0]) * static_cast<std::size_t>(tables_[1]);
  if (layer > kMostTables || layer * static_cast<std::size_t>(tables_[2]) > kMostTables)
    throw std::length_error("the blocks lie too far apart");
  table_of_.assign(layer * static_cast<std::size_t>(tables_[2]), kMissing);
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const Node& c = corners_[i];
    std::uint32_t& table =
        table_of_[(static_cast<std::size_t>(c.z >> 7) * tables_[1] + (c.y >> 7)) * tables_[0] + (c.x >> 7)];
    if (table == kMissing) {
      table = static_cast<std::uint32_t>(blocks_of_.size() / kTable);
      blocks_of_.resize(blocks_of_.size() + kTable, kMissing);
    }
    const auto at = static_cast<std::size_t>(((c.z >> 3 & 15) * 16 + (c.y >> 3 & 15)) * 16 + (c.x >> 3 & 15));
    blocks_of_[table * kTable + at] = static_cast<std::uint32_t>(i);
  }
}

void Samples::sample(const FillBlock& fill_block) {
  values_.resize(corners_.size() * kNodes);
  const auto fill = [&](std::size_t first, std::size_t stride) {
    for (std::size_t i = first; i < corners_.size(); i += stride)
      fill_block(i, position(corners_[i]), &values_[i * kNodes]);
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

void keep_one_cave(Samples& s, const core::Vec3& start) { keep_caves(s, {&start, 1}); }

void keep_caves(Samples& s, std::span<const core::Vec3> places) {
  const auto mark = [&s](std::vector<std::vector<bool>>& marks, const std::vector<Node>& seeds,
                         const auto& belongs) {
    std::vector<Node> queue;
    const auto visit = [&](const Node& n) {
      const std::size_t i = s.block_of(n);
      if (i == Samples::kNone || !belongs(n)) return;
      std::vector<bool>& block = marks[i];
      if (block.empty()) block.resize(Samples::kEdge * Samples::kEdge * Samples::kEdge);
      if (block[Samples::inside(n)]) return;
      block[Samples::inside(n)] = true;
      queue.push_back(n);
    };
    for (const Node& seed : seeds) {
      visit(seed);
      while (!queue.empty()) {
        const Node n = queue.back();
        queue.pop_back();
        for (const Node& f : kFaces) visit(n + f);
      }
    }
  };
  std::vector<std::vector<bool>> cave(s.block_count()), rock(s.block_count());
  std::vector<Node> seeds;
  for (const core::Vec3& p : places) seeds.push_back(s.nearest(p));
  mark(cave, seeds, [&s](const Node& n) { return s.hollow(n); });
  std::vector<Node> outer;
  s.for_each([&](const Node& n) {
    for (const Node& f : kFaces)
      if (!s.has_block(n + f)) outer.push_back(n);
  });
  mark(rock, outer, [&s](const Node& n) { return !s.hollow(n); });
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
