#include "sdk/evaluation/reachable/sight.h"

#include <array>
#include <cmath>
#include <numbers>

namespace karst::evaluation {
namespace {

using core::Vec3;

/// 64 cells of one height at any position: the 8x8 cells from `low` on, from up to four blocks.
std::uint64_t window(const CellSet& set, const CellKey& low) {
  const CellKey place = set.block_of(low);
  const int x = low.x & 7, y = low.y & 7;
  const auto slice = [&](int dx, int dy) -> std::uint64_t {
    const auto* b = set.find({place.x + dx, place.y + dy, place.z});
    return b ? (*b)[low.z & 7] : 0;
  };
  const auto rows = [&](int dy) {  // shifted along x: the low cells of each row come from the next block
    if (x == 0) return slice(0, dy);
    const std::uint64_t near = 0x0101010101010101ull * (0xffull >> x);
    return (slice(0, dy) >> x & near) | (slice(1, dy) << (8 - x) & ~near);
  };
  return y == 0 ? rows(0) : rows(0) >> (8 * y) | rows(1) << (64 - 8 * y);
}

/// Blocks of `free` from which a ray of `steps` blocks' length can reach `flyable` at all.
std::vector<CellKey> blocks_in_range(const CellSet& flyable, const CellSet& free, int steps) {
  std::vector<bool> met(free.block_count());
  std::vector<CellKey> blocks;
  flyable.for_each_block([&](const CellKey& p, const CellSet::Block&) {
    met[static_cast<std::size_t>(free.number_of(p))] = true;
    blocks.push_back(p);
  });
  for (std::size_t begin = 0; steps > 0; --steps) {
    const std::size_t end = blocks.size();
    for (; begin < end; ++begin)
      for (int i = 0; i < 27; ++i) {
        const CellKey next = blocks[begin] + CellKey{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
        const std::int32_t number = free.number_of(next);
        if (number < 0 || met[static_cast<std::size_t>(number)]) continue;
        met[static_cast<std::size_t>(number)] = true;
        blocks.push_back(next);
      }
  }
  return blocks;
}

}  // namespace

const std::vector<Vec3>& sight_directions() {
  static const std::vector<Vec3> directions = [] {
    std::vector<Vec3> d;
    for (const int norm : {1, 2, 3})  // faces first: most free cells near a wall are visible along them
      for (int i = 0; i < 27; ++i) {
        const int x = i % 3 - 1, y = i / 3 % 3 - 1, z = i / 9 - 1;
        const Vec3 step(x, y, z);
        if (static_cast<int>(step.squaredNorm()) == norm) d.push_back(step.normalized());
      }
    constexpr int kSpread = 256;
    for (int i = 0; i < kSpread; ++i) {  // a Fibonacci spiral
      const double z = 1 - (2.0 * i + 1) / kSpread, across = std::sqrt(1 - z * z);
      const double turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
      d.push_back({across * std::cos(turn), across * std::sin(turn), z});
    }
    return d;
  }();
  return directions;
}

std::vector<CellKey> cells_along(const Vec3& direction, double cells) {
  std::vector<CellKey> out;
  CellKey k;
  const std::array<std::int32_t*, 3> along{&k.x, &k.y, &k.z};
  const Vec3 step = direction.cwiseAbs().cwiseInverse();  // infinite for an axis the ray does not move along
  Vec3 next = 0.5 * step;                                 // ray parameter of the next border
  for (;;) {
    int axis = 0;
    if (next[1] < next[axis]) axis = 1;
    if (next[2] < next[axis]) axis = 2;
    if (next[axis] > cells) return out;
    next[axis] += step[axis];
    *along[static_cast<std::size_t>(axis)] += direction[axis] > 0 ? 1 : -1;
    out.push_back(k);
  }
}

CellSet seen_from(const CellSet& flyable, const CellSet& free, double cells) {
  std::vector<std::vector<CellKey>> sights;
  for (const Vec3& d : sight_directions()) sights.push_back(cells_along(d, cells));
  CellSet seen = flyable;
  const int steps = static_cast<int>(std::ceil(cells / CellSet::kEdge)) + 1;
  // All rays of one direction pass the same cells relative to their start, so 64 rays are cast at a time.
  for (const CellKey& place : blocks_in_range(flyable, free, steps)) {
    const CellKey corner = free.first_cell(place);
    CellSet::Block block{};
    if (const auto* flown = flyable.find(place)) block = *flown;
    for (std::int32_t z = 0; z < CellSet::kEdge; ++z) {
      std::uint64_t& known = block[static_cast<std::size_t>(z)];
      std::uint64_t unseen = (*free.find(place))[static_cast<std::size_t>(z)] & ~known;
      for (const std::vector<CellKey>& sight : sights) {
        if (!unseen) break;
        std::uint64_t rays = unseen;
        for (const CellKey& step : sight) {
          const CellKey low = corner + step + CellKey{0, 0, z};
          rays &= window(free, low);
          if (!rays) break;
          const std::uint64_t arrived = rays & window(flyable, low);
          known |= arrived;
          rays &= ~arrived;
        }
        unseen &= ~known;
      }
    }
    seen.at(place) = block;
  }
  return seen;
}

}  // namespace karst::evaluation
