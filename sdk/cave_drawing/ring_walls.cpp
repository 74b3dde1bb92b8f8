#include "sdk/cave_drawing/ring_walls.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "sdk/cave_drawing/smooth_line.h"

namespace karst::cave_drawing {
namespace {

constexpr double kWindow_m = 1.0;
constexpr double kFewestPoints = 0.08;  // cells by which a line may be simplified

/// The full cell to the left of a step along a ring, and on which of its sides the step is.
bool is_known_beside(const Point& from, const Point& to, const IsWallKnown& is_known) {
  const int x = static_cast<int>(std::lround(from.x())), y = static_cast<int>(std::lround(from.y()));
  if (to.x() > from.x()) return is_known(x, y, 0);
  if (to.y() > from.y()) return is_known(x - 1, y, 1);
  if (to.x() < from.x()) return is_known(x - 1, y - 1, 2);
  return is_known(x, y - 1, 3);
}

/// As most sides are within the window around each.
std::vector<bool> as_most_around(const std::vector<bool>& known, std::size_t half_window) {
  const std::size_t n = known.size(), half = std::min(half_window, (n - 1) / 2);
  std::size_t in_window = 0;
  for (std::size_t k = 0; k <= 2 * half; ++k) in_window += known[(n - half + k) % n] ? 1u : 0u;
  std::vector<bool> out(n);
  for (std::size_t i = 0; i < n; ++i) {
    out[i] = 2 * in_window > 2 * half;
    in_window += known[(i + half + 1) % n] ? 1u : 0u;
    in_window -= known[(i + n - half) % n] ? 1u : 0u;
  }
  return out;
}

}  // namespace

void add_ring_walls(const Line& ring, double cell_m, const IsWallKnown& is_known, Drawing& drawing) {
  const auto add = [&](const Line& line, bool known) {
    (known ? drawing.walls : drawing.uncertain_walls)
        .push_back(scaled(simplified(line, kFewestPoints), cell_m));
  };
  const Line smooth = smoothed(ring);  // a point for each side, and the first once more
  if (!is_known || ring.size() < 5) return add(smooth, true);
  const std::size_t n = ring.size() - 1;
  std::vector<bool> known(n);
  for (std::size_t i = 0; i < n; ++i) known[i] = is_known_beside(ring[i], ring[i + 1], is_known);
  known = as_most_around(known, static_cast<std::size_t>(std::lround(0.5 * kWindow_m / cell_m)));
  std::size_t first = 0;  // where one stretch ends and the next begins
  while (first < n && known[first] == known[(first + n - 1) % n]) ++first;
  if (first == n) return add(smooth, known[0]);
  Line line;
  for (std::size_t k = 0; k <= n; ++k) {
    const std::size_t i = (first + k) % n, before = (i + n - 1) % n;
    line.push_back(smooth[i]);
    if (k == 0 || (k < n && known[i] == known[before])) continue;
    add(line, known[before]);
    line.assign(1, smooth[i]);
  }
}

}  // namespace karst::cave_drawing
