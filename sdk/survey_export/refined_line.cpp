#include "sdk/survey_export/refined_line.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core_stack/planning/free_space/free_way.h"
#include "core_stack/planning/passages/cross_section.h"

namespace karst::survey_export {
namespace {

using core::Vec3;

/// Two directions across a tangent, the first of them level.
std::array<Vec3, 2> across(const Vec3& tangent) {
  Vec3 side = tangent.cross(Vec3::UnitZ());
  side = side.norm() > 0.1 ? side.normalized() : Vec3::UnitX();
  return {side, side.cross(tangent).normalized()};
}

/// How far to move along `side` from a place with these reaches to both sides. Where the space is much wider
/// than the passage is around there (`half_m`), a side passage opens, and the nearer wall counts alone.
double to_middle_m(double ahead_m, double behind_m, double half_m) {
  constexpr double kOpens = 1.6;
  if (ahead_m + behind_m < kOpens * 2 * half_m) return 0.5 * (ahead_m - behind_m);
  return ahead_m > behind_m ? half_m - behind_m : ahead_m - half_m;
}

class Refinement {
 public:
  Refinement(const core::VoxelMap& map, const std::vector<LinePoint>& coarse, std::array<bool, 2> free_end)
      : map_(map) {
    for (std::size_t i = 0; i < coarse.size(); ++i) {
      if (i > 0) add_between(coarse[i - 1], coarse[i]);
      points_.push_back(coarse[i]);
    }
    first_ = free_end[0] ? 0 : 1;
    end_ = points_.size() - (free_end[1] ? 0 : 1);
  }

  std::vector<LinePoint> refined() {
    constexpr int kRounds = 8;
    for (int round = 0; round < kRounds && points_.size() > 1; ++round) {
      const std::vector<Cross> crosses = measured();
      std::vector<LinePoint> moved = points_;
      for (std::size_t i = first_; i < end_; ++i) moved[i].position = moved_from(i, crosses);
      for (std::size_t i = first_; i < end_; ++i)
        if (sees(map_, points_[i].position, moved[i].position)) points_[i].position = moved[i].position;
    }
    const std::vector<Cross> crosses = measured();
    for (std::size_t i = first_; i < end_; ++i) {
      points_[i].width_m = crosses[i].reaches[0][0] + crosses[i].reaches[0][1];
      points_[i].height_m = crosses[i].reaches[1][0] + crosses[i].reaches[1][1];
    }
    return std::move(points_);
  }

 private:
  static constexpr double kSpacing_m = 0.5, kMostMove_m = 0.3;
  static constexpr std::size_t kTangent = 2, kAround = 8;  // points to either side

  /// The line's direction at a point; two directions across it, and how far the space reaches along each of
  /// them, ahead and behind.
  struct Cross {
    Vec3 along = Vec3::Zero();
    std::array<Vec3, 2> sides{};
    std::array<std::array<double, 2>, 2> reaches{};
  };

  void add_between(const LinePoint& a, const LinePoint& b) {
    const int steps = static_cast<int>(std::ceil((b.position - a.position).norm() / kSpacing_m));
    for (int k = 1; k < steps; ++k) {
      const double f = static_cast<double>(k) / steps;
      LinePoint p = f < 0.5 ? a : b;
      p.position = a.position + f * (b.position - a.position);
      if (map_.at(p.position) != core::Cell::free) {
        const std::optional<Vec3> near = free_near(map_, p.position);
        if (!near) continue;
        p.position = *near;
      }
      points_.push_back(p);
    }
  }

  std::vector<Cross> measured() const {
    std::vector<Cross> out(points_.size());
    const std::size_t n = points_.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 along =
          points_[std::min(i + kTangent, n - 1)].position - points_[i < kTangent ? 0 : i - kTangent].position;
      if (along.norm() < 1e-3) continue;
      out[i].along = along.normalized();
      out[i].sides = across(out[i].along);
      for (std::size_t side = 0; side < 2; ++side)
        out[i].reaches[side] = {free_reach_m(map_, points_[i].position, out[i].sides[side]),
                                free_reach_m(map_, points_[i].position, -out[i].sides[side])};
    }
    return out;
  }

  /// Half of the width (side 0) or height (side 1) around a point: the median.
  static double half_m(const std::vector<Cross>& crosses, std::size_t i, std::size_t side) {
    std::vector<double> halves;
    for (std::size_t k = i < kAround ? 0 : i - kAround; k < std::min(crosses.size(), i + kAround + 1); ++k)
      halves.push_back(0.5 * (crosses[k].reaches[side][0] + crosses[k].reaches[side][1]));
    const auto middle = halves.begin() + static_cast<std::ptrdiff_t>(halves.size() / 2);
    std::nth_element(halves.begin(), middle, halves.end());
    return *middle;
  }

  /// Across the line to its middle, and along it halfway between the neighbours.
  Vec3 moved_from(std::size_t i, const std::vector<Cross>& crosses) const {
    const Cross& cross = crosses[i];
    Vec3 p = points_[i].position;
    for (std::size_t side = 0; side < 2; ++side) {
      const auto [ahead_m, behind_m] = cross.reaches[side];
      p += std::clamp(to_middle_m(ahead_m, behind_m, half_m(crosses, i, side)), -kMostMove_m, kMostMove_m) *
           cross.sides[side];
    }
    if (i == 0 || i + 1 == points_.size()) return p;
    const Vec3 halfway = 0.5 * (points_[i - 1].position + points_[i + 1].position);
    return p + (halfway - points_[i].position).dot(cross.along) * cross.along;
  }

  const core::VoxelMap& map_;
  std::vector<LinePoint> points_;
  std::size_t first_ = 0, end_ = 0;  // the points that may move
};

}  // namespace

std::vector<LinePoint> refined_line(const core::VoxelMap& map, const std::vector<LinePoint>& coarse,
                                    std::array<bool, 2> free_end) {
  return Refinement(map, coarse, free_end).refined();
}

}  // namespace karst::survey_export
