#include "sdk/survey_export/refined_line.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core_stack/planning/free_space/free_way.h"
#include "core_stack/planning/passages/cross_section.h"
#include "sdk/survey_export/axes.h"
#include "sdk/survey_export/median.h"

namespace karst::survey_export {
namespace {

using core::Vec3;

/// Two directions across a tangent, the first of them level.
std::array<Vec3, 2> across(const Vec3& tangent) {
  Vec3 side = tangent.cross(Vec3::UnitZ());
  side = side.norm() > 0.1 ? side.normalized() : Vec3::UnitX();
  return {side, side.cross(tangent).normalized()};
}

constexpr double kSpacing_m = 0.5;

/// How far to move along `side` from a place with these reaches to both sides. Where the space is much wider
/// than the passage is around there (`half_m`), a side passage opens, and the nearer wall counts alone.
double to_middle_m(double ahead_m, double behind_m, double half_m) {
  constexpr double kOpens = 1.6;
  if (ahead_m + behind_m < kOpens * 2 * half_m) return 0.5 * (ahead_m - behind_m);
  return ahead_m > behind_m ? half_m - behind_m : ahead_m - half_m;
}

double turn_rad(const Vec3& before, const Vec3& after) {
  return std::atan2(before.cross(after).norm(), before.dot(after));
}

/// The line in steps of half a metre. Round by round, its points move to the middle.
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
        if (!sees(map_, points_[i].position, moved[i].position)) moved[i].position = points_[i].position;
      take_back_folds(moved);
      points_ = std::move(moved);
    }
    const std::vector<Cross> crosses = measured();
    for (std::size_t i = first_; i < end_; ++i) {
      points_[i].width_m = crosses[i].reaches[0][0] + crosses[i].reaches[0][1];
      points_[i].height_m = crosses[i].reaches[1][0] + crosses[i].reaches[1][1];
    }
    return std::move(points_);
  }

 private:
  static constexpr double kMostMove_m = 0.3;
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
    return median(std::move(halves));
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

  /// Takes back moves that make a sharp turn sharper, their own or a neighbour's: such a line folds, since
  /// then the next tangent points sideways.
  void take_back_folds(std::vector<LinePoint>& moved) const {
    constexpr double kSharp_rad = 0.9;
    const auto turned_rad = [](const std::vector<LinePoint>& points, std::size_t i) {
      return turn_rad(points[i].position - points[i - 1].position,
                      points[i + 1].position - points[i].position);
    };
    const auto folds = [&](std::size_t i) {
      if (i == 0 || i + 1 >= moved.size()) return false;
      const double turn = turned_rad(moved, i);
      return turn > kSharp_rad && turn > turned_rad(points_, i) + 1e-9;
    };
    for (bool changed = true; changed;) {  // each round takes back a move or is the last
      changed = false;
      for (std::size_t i = first_; i < end_; ++i) {
        if (moved[i].position == points_[i].position) continue;
        if (!folds(i) && !(i > 0 && folds(i - 1)) && !folds(i + 1)) continue;
        moved[i].position = points_[i].position;
        changed = true;
      }
    }
  }

  const core::VoxelMap& map_;
  std::vector<LinePoint> points_;
  std::size_t first_ = 0, end_ = 0;  // the points that may move
};

/// The median width of the points around each.
std::vector<double> usual_widths(const std::vector<LinePoint>& points) {
  constexpr std::size_t kAround = 12;
  std::vector<double> out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::vector<double> widths;
    for (std::size_t k = i < kAround ? 0 : i - kAround; k < std::min(points.size(), i + kAround + 1); ++k)
      widths.push_back(points[k].width_m);
    out.push_back(median(std::move(widths)));
  }
  return out;
}

/// Replaces the points in sharp bends, where rays across the line look along it, by one where the axes before
/// and after the bend meet.
class Bends {
 public:
  Bends(const core::VoxelMap& map, std::vector<LinePoint> points)
      : map_(map), points_(std::move(points)), usual_m_(usual_widths(points_)) {}

  std::vector<LinePoint> sharpened() const {
    std::vector<LinePoint> out;
    std::size_t straight = 0;  // the first point after the last bend
    for (std::size_t i = 0; i < points_.size();) {
      const std::size_t end = bend_end(i);
      const std::optional<LinePoint> corner = end > i ? corner_of(i, end, straight) : std::nullopt;
      if (corner) {
        out.push_back(*corner);
        i = straight = end;
      } else {
        for (const std::size_t next = std::max(end, i + 1); i < next; ++i) out.push_back(points_[i]);
      }
    }
    return out;
  }

 private:
  static constexpr std::size_t kLeastAxis = 4, kMostAxis = 8;  // points of which an axis is found

  bool is_bend(std::size_t i) const {
    constexpr double kUnusual = 1.25, kTurn_rad = 0.35;
    constexpr std::size_t kStep = 4;
    if (points_[i].width_m > kUnusual * usual_m_[i]) return true;
    if (i < kStep || i + kStep >= points_.size()) return false;
    return turn_rad(points_[i].position - points_[i - kStep].position,
                    points_[i + kStep].position - points_[i].position) > kTurn_rad;
  }
  /// How many points before and after a bend the line is not yet on the axis.
  std::size_t reach(std::size_t i) const { return static_cast<std::size_t>(0.5 * usual_m_[i] / kSpacing_m); }

  /// One after the last point of the bend that begins at `first`; `first` if none does.
  std::size_t bend_end(std::size_t first) const {
    constexpr std::size_t kGap = 2;
    const std::size_t turn = first + reach(first);
    if (turn >= points_.size() || !is_bend(turn)) return first;
    std::size_t last = turn;
    for (std::size_t i = turn + 1; i < points_.size() && i - last <= kGap + 1; ++i)
      if (is_bend(i)) last = i;
    return std::min(last + 1 + reach(last), points_.size());
  }

  /// Of the bend from `first` to before `end`; the axis before it begins at `straight` or later.
  std::optional<LinePoint> corner_of(std::size_t first, std::size_t end, std::size_t straight) const {
    constexpr double kLeast_rad = 0.35, kLongest = 4;
    if (first < straight + kLeastAxis || end + kLeastAxis > points_.size())
      return std::nullopt;  // no axis on that side
    const std::span<const LinePoint> all(points_);
    const std::size_t from = std::max(straight, first - std::min(first, kMostAxis));
    const Axis before = axis_of(all.subspan(from, first - from)),
               after = axis_of(all.subspan(end, std::min(kMostAxis, all.size() - end)));
    const LinePoint &a = points_[first - 1], &b = points_[end];
    const double usual_m = std::min(usual_m_[first - 1], usual_m_[end]);
    if ((b.position - a.position).norm() > kLongest * usual_m ||
        turn_rad(before.direction, after.direction) < kLeast_rad)
      return std::nullopt;
    const Vec3 halfway = 0.5 * (a.position + b.position);
    const Vec3 meeting = meeting_of(std::array{before, after}, halfway);
    const bool ahead =
        (meeting - a.position).dot(before.direction) >= 0 && (b.position - meeting).dot(after.direction) >= 0;
    if (!ahead || (meeting - halfway).norm() > kLongest * usual_m || !sees(map_, a.position, meeting) ||
        !sees(map_, meeting, b.position))
      return std::nullopt;
    LinePoint corner = a;
    corner.position = meeting;
    corner.flown = a.flown && b.flown;
    return corner;
  }

  const core::VoxelMap& map_;
  std::vector<LinePoint> points_;
  std::vector<double> usual_m_;
};

/// Without its last points where they turn aside, into a corner of the end of the passage.
void cut_turned_end(std::vector<LinePoint>& points) {
  constexpr double kTurn_rad = 0.6;
  constexpr std::size_t kAxis = 4;
  if (points.size() < kAxis + 2) return;
  const double usual_m = usual_widths(points)[points.size() - 1];
  std::size_t first = points.size() - 1;  // from here on the line is no longer than the passage is wide
  for (double tail_m = 0; first > kAxis; --first) {
    tail_m += (points[first].position - points[first - 1].position).norm();
    if (tail_m > usual_m) break;
  }
  for (std::size_t i = std::max(first, kAxis); i + 1 < points.size(); ++i) {
    const Vec3 along = points[i].position - points[i - kAxis].position;
    if (turn_rad(along, points.back().position - points[i].position) < kTurn_rad) continue;
    points.erase(points.begin() + static_cast<std::ptrdiff_t>(i) + 1, points.end());
    return;
  }
}

}  // namespace

std::vector<LinePoint> refined_line(const core::VoxelMap& map, const std::vector<LinePoint>& coarse,
                                    std::array<bool, 2> free_end) {
  std::vector<LinePoint> points = Bends(map, Refinement(map, coarse, free_end).refined()).sharpened();
  if (free_end[1]) cut_turned_end(points);
  if (free_end[0]) {
    std::reverse(points.begin(), points.end());
    cut_turned_end(points);
    std::reverse(points.begin(), points.end());
  }
  return points;
}

}  // namespace karst::survey_export
