#include "sdk/cave_drawing/way_between.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core_stack/planning/free_space/free_way.h"

namespace karst::cave_drawing {
namespace {

using core::Vec3;

constexpr double kAround_m = 3;
constexpr std::size_t kMostSeen = 200'000;

std::vector<Vec3> straight_way(const Vec3& from, const Vec3& to, double step_m) {
  const auto n = std::max(1, static_cast<int>(std::ceil((to - from).norm() / step_m)));
  std::vector<Vec3> way;
  for (int k = 0; k <= n; ++k) way.push_back(from + static_cast<double>(k) / n * (to - from));
  return way;
}

}  // namespace

std::vector<Vec3> way_between(const core::VoxelMap& map, const Vec3& from, const Vec3& to, double step_m) {
  const std::vector<Vec3> straight = straight_way(from, to, step_m);
  const auto is_free = [&](const Vec3& p) { return map.at(p) == core::Cell::free; };
  if (std::all_of(straight.begin(), straight.end(), is_free) || !is_free(from) || !is_free(to))
    return straight;
  std::optional<std::vector<Vec3>> way = core::free_way(map, from, to, kAround_m, kMostSeen);
  if (!way) return straight;
  way->back() = to;
  way->insert(way->begin(), from);
  return *std::move(way);
}

}  // namespace karst::cave_drawing
