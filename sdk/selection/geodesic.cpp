#include "sdk/selection/geodesic.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <queue>

namespace karst::selection {
namespace {

using core::CellKey;
using Entry = std::pair<float, std::int32_t>;
using Queue = std::priority_queue<Entry, std::vector<Entry>, std::greater<>>;

struct Move {
  CellKey step;
  float length;
  // A long move passes between these two cells, both of which must exist; (0, 0, 0) for a short move.
  CellKey before, after;
};

std::vector<Move> moves(int radius) {
  std::vector<Move> all;
  const auto half_down = [](int v) { return static_cast<int>(std::floor(v / 2.0)); };
  const auto half_up = [](int v) { return static_cast<int>(std::ceil(v / 2.0)); };
  for (int z = -radius; z <= radius; ++z)
    for (int y = -radius; y <= radius; ++y)
      for (int x = -radius; x <= radius; ++x) {
        if (std::gcd(std::gcd(std::abs(x), std::abs(y)), std::abs(z)) != 1) continue;
        Move m{{x, y, z}, std::sqrt(static_cast<float>(x * x + y * y + z * z)), {}, {}};
        if (std::max({std::abs(x), std::abs(y), std::abs(z)}) == 2) {
          m.before = {half_down(x), half_down(y), half_down(z)};
          m.after = {half_up(x), half_up(y), half_up(z)};
        }
        all.push_back(m);
      }
  return all;
}

/// Dijkstra, 1959; equal distances are processed in the order of the cells' numbers.
void spread(const CellIndex& cells, const std::vector<Move>& all, Queue& queue,
            std::vector<float>& distance) {
  while (!queue.empty()) {
    const auto [d, i] = queue.top();
    queue.pop();
    if (d > distance[static_cast<std::size_t>(i)]) continue;
    const CellKey& k = cells.key(static_cast<std::size_t>(i));
    for (const Move& m : all) {
      const std::int32_t next = cells.at(k + m.step);
      if (next < 0) continue;
      float& there = distance[static_cast<std::size_t>(next)];
      if (d + m.length >= there) continue;
      if (m.before != CellKey{} || m.after != CellKey{})
        if (cells.at(k + m.before) < 0 || cells.at(k + m.after) < 0) continue;
      there = d + m.length;
      queue.emplace(there, next);
    }
  }
}

}  // namespace

std::vector<float> distances_from(const CellIndex& cells, std::size_t source) {
  static const std::vector<Move> all = moves(2);
  std::vector<float> distance(cells.size(), std::numeric_limits<float>::infinity());
  Queue queue;
  distance[source] = 0;
  queue.emplace(0.0f, static_cast<std::int32_t>(source));
  spread(cells, all, queue, distance);
  return distance;
}

std::vector<float> depths(const CellIndex& cells) {
  static const std::vector<Move> all = moves(1);
  std::vector<float> distance(cells.size(), std::numeric_limits<float>::infinity());
  Queue queue;
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (const Move& m : all)
      if (cells.at(cells.key(i) + m.step) < 0) distance[i] = std::min(distance[i], m.length);
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (std::isfinite(distance[i])) queue.emplace(distance[i], static_cast<std::int32_t>(i));
  spread(cells, all, queue, distance);
  return distance;
}

}  // namespace karst::selection
