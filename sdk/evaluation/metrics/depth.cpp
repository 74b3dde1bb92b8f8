#include "sdk/evaluation/metrics/depth.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <tuple>

namespace karst::evaluation {
namespace {

using core::Vec3;

constexpr double kSpacing_m = 0.25;
constexpr double kLink_m = 0.6;  // twice the radius of the hull

using Bin = std::tuple<int, int, int>;  // cubes of kLink_m

Bin bin_of(const Vec3& p, int dx = 0, int dy = 0, int dz = 0) {
  const auto k = [](double v) { return static_cast<int>(std::floor(v / kLink_m)); };
  return {k(p.x()) + dx, k(p.y()) + dy, k(p.z()) + dz};
}

std::vector<Vec3> thinned(const std::vector<Vec3>& positions) {
  std::vector<Vec3> kept;
  for (const Vec3& p : positions)
    if (p.allFinite() && (kept.empty() || (p - kept.back()).norm() >= kSpacing_m)) kept.push_back(p);
  return kept;
}

}  // namespace

double depth_along_path(const std::vector<Vec3>& positions) {
  const std::vector<Vec3> path = thinned(positions);
  if (path.empty()) return 0;
  std::map<Bin, std::vector<std::size_t>> bins;
  for (std::size_t i = 0; i < path.size(); ++i) bins[bin_of(path[i])].push_back(i);

  std::vector<double> distance_m(path.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto reach = [&](std::size_t to, double d) {
    if (d < distance_m[to]) queue.emplace(distance_m[to] = d, to);
  };
  reach(0, 0);
  while (!queue.empty()) {  // Dijkstra
    const double d = queue.top().first;
    const std::size_t at = queue.top().second;
    queue.pop();
    if (d > distance_m[at]) continue;
    const auto step = [&](std::size_t to) { reach(to, d + (path[to] - path[at]).norm()); };
    if (at > 0) step(at - 1);
    if (at + 1 < path.size()) step(at + 1);
    for (int i = 0; i < 27; ++i) {
      const auto bin = bins.find(bin_of(path[at], i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
      if (bin == bins.end()) continue;
      for (const std::size_t to : bin->second)
        if ((path[to] - path[at]).norm() <= kLink_m) step(to);
    }
  }
  return *std::max_element(distance_m.begin(), distance_m.end());
}

double vertical_reach(const std::vector<Vec3>& positions) {
  double reach_m = 0;
  for (const Vec3& p : positions)
    if (p.allFinite()) reach_m = std::max(reach_m, std::abs(p.z() - positions.front().z()));
  return reach_m;
}

}  // namespace karst::evaluation
