#include "sdk/cave_drawing/smooth_line.h"

#include <algorithm>
#include <utility>

namespace karst::cave_drawing {
namespace {

constexpr double kMostMoved = 0.5;  // cells
constexpr int kRounds = 12;
// Each round moves points towards those beside them, and then away from them by a little more: else curves
// would shrink (Taubin, A signal processing approach to fair surface design, 1995).
constexpr double kTowards = 0.5, kAway = -0.52;

bool is_closed(const Line& line) { return line.size() > 2 && line.front() == line.back(); }

/// The middles of the sides; of an open line the ends, too.
Line middles_of(const Line& steps) {
  Line out;
  if (!is_closed(steps)) out.push_back(steps.front());
  for (std::size_t i = 1; i < steps.size(); ++i) out.push_back(0.5 * (steps[i - 1] + steps[i]));
  if (!is_closed(steps)) out.push_back(steps.back());
  return out;
}

double distance_to_segment(const Point& p, const Point& a, const Point& b) {
  const Point along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
}

}  // namespace

Line smoothed(const Line& steps) {
  if (steps.size() < 3) return steps;
  const bool closed = is_closed(steps);
  const Line from = middles_of(steps);
  Line at = from;
  const std::size_t n = at.size();
  const std::size_t first = closed ? 0 : 1, last = closed ? n : n - 1;
  for (int round = 0; round < 2 * kRounds; ++round) {
    const double share = round % 2 == 0 ? kTowards : kAway;
    const Line before = at;
    for (std::size_t i = first; i < last; ++i) {
      const Point mean = 0.5 * (before[(i + n - 1) % n] + before[(i + 1) % n]);
      const Point moved = before[i] + share * (mean - before[i]) - from[i];
      at[i] = from[i] + moved * std::min(1.0, kMostMoved / std::max(moved.norm(), 1e-12));
    }
  }
  if (closed) at.push_back(at.front());
  return at;
}

Line simplified(const Line& line, double most) {
  if (line.size() < 3) return line;
  std::vector<bool> kept(line.size(), false);
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> spans{{0, line.size() - 1}};
  while (!spans.empty()) {
    const auto [a, b] = spans.back();
    spans.pop_back();
    double farthest = most;
    std::size_t at = a;
    for (std::size_t i = a + 1; i < b; ++i) {
      const double d = distance_to_segment(line[i], line[a], line[b]);
      if (d > farthest) farthest = d, at = i;
    }
    if (at == a) continue;
    kept[at] = true;
    spans.emplace_back(a, at);
    spans.emplace_back(at, b);
  }
  Line out;
  for (std::size_t i = 0; i < line.size(); ++i)
    if (kept[i]) out.push_back(line[i]);
  return out;
}

Line scaled(const Line& line, double cell_m) {
  Line out;
  out.reserve(line.size());
  for (const Point& p : line) out.push_back(cell_m * p);
  return out;
}

}  // namespace karst::cave_drawing
