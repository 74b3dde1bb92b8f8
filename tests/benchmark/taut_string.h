// A path made as short as it gets without leaving the clear space it runs through: what planned paths are
// measured by. Slow; shares nothing with refining but the question whether a segment is clear.
#pragma once
#include <vector>

#include "core_stack/common/random.h"
#include "core_stack/planning/free_space/free_tiles.h"
#include "core_stack/planning/path/path.h"

namespace karst::core::bench {

struct OnPath {
  std::size_t segment = 0;
  Vec3 point = Vec3::Zero();
};

inline OnPath at_length(const std::vector<Vec3>& points, double s) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double l = (points[i + 1] - points[i]).norm();
    if (s <= l) return {i, l > 0 ? Vec3(points[i] + (points[i + 1] - points[i]) * s / l) : points[i]};
    s -= l;
  }
  return {points.size() - 2, points.back()};
}

/// Random shortcuts between any two places of the path, near ones and far ones alike, until `tries` are used
/// up. Each that is clear is taken; two places on different segments make it shorter.
inline std::vector<Vec3> taut_string(const FreeTiles& free, double clearance_m, std::vector<Vec3> points,
                                     int tries) {
  Random random(7);
  double length = path_length_m(points);
  for (int i = 0; i < tries; ++i) {
    const double reach = length * std::pow(0.01, random.uniform());
    const double s = random.uniform(0, length), e = std::min(length, s + reach);
    const OnPath a = at_length(points, s), b = at_length(points, e);
    if (a.segment == b.segment || !free.segment_clear(a.point, b.point, clearance_m)) continue;
    std::vector<Vec3> next(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(a.segment) + 1);
    next.push_back(a.point), next.push_back(b.point);
    next.insert(next.end(), points.begin() + static_cast<std::ptrdiff_t>(b.segment) + 1, points.end());
    points = std::move(next);
    length = path_length_m(points);
  }
  return points;
}

}  // namespace karst::core::bench
