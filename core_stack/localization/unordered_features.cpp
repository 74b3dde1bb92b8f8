#include "core_stack/localization/unordered_features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "core_stack/common/direction_cells.h"
#include "core_stack/localization/parallel.h"

namespace karst::core {
namespace {

constexpr float kCell_rad = 0.02f;                              // of the search
constexpr float kPlaneCell_rad = 0.07f, kEdgeCell_rad = 0.14f;  // that give a feature each
constexpr float kMinWindow_rad = 0.035f, kMaxWindow_rad = 0.17f;
constexpr std::size_t kMostInWindow = 40, kFewestInWindow = 7;
constexpr float kMaxOffCentre =
    0.3f;  // of the window's radius: the mean of half a disc lies 0.42 off its centre
constexpr float kMaxSlopeOfRange = 0.05f;  // gap in the ranges, of the range
constexpr float kNoSharpness = -1;
constexpr std::size_t kPointsPerChunk = 512;

struct WindowPoint {
  Vec3f offset;  // of the unit vectors
  float distance2, range;
};

/// The points around a direction; no more than kMostInWindow, taken evenly.
class Window {
 public:
  void gather(const DirectionCells& cells, const std::vector<Vec3f>& directions,
              const std::vector<float>& ranges, std::size_t centre, float radius_rad) {
    count_ = 0;
    runs_.clear();
    std::size_t candidates = 0;
    cells.for_each_run(directions[centre], radius_rad, [&](std::size_t first, std::size_t end) {
      runs_.emplace_back(first, end);
      candidates += end - first;
    });
    // Cells at the border of the window hold points outside: about a third of all.
    const std::size_t step = std::max<std::size_t>(1, 2 * candidates / (3 * kMostInWindow));
    const float radius2 = radius_rad * radius_rad;
    std::size_t skip = 0;
    for (const auto& [first, end] : runs_) {
      std::size_t at = first + skip;
      for (; at < end && count_ < members_.size(); at += step) {
        const std::size_t i = cells.order()[at];
        const Vec3f offset = directions[i] - directions[centre];
        const float distance2 = offset.squaredNorm();
        if (i != centre && distance2 <= radius2) members_[count_++] = {offset, distance2, ranges[i]};
      }
      skip = at - end;
    }
  }
  std::span<const WindowPoint> members() const { return {members_.data(), count_}; }

 private:
  std::array<WindowPoint, kMostInWindow + kMostInWindow / 2> members_;
  std::size_t count_ = 0;
  std::vector<std::pair<std::size_t, std::size_t>> runs_;  // of the cells in reach
};

/// Whether the sorted ranges of the window and of its centre have no gap that only an occlusion makes.
bool is_one_surface(std::span<const WindowPoint> members, float range, float jump_m) {
  std::array<float, 2 * kMostInWindow> sorted;
  std::size_t n = 0;
  for (const WindowPoint& m : members) sorted[n++] = m.range;
  sorted[n++] = range;
  std::sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(n));
  for (std::size_t i = 1; i < n; ++i)
    if (sorted[i] - sorted[i - 1] > std::max(jump_m, kMaxSlopeOfRange * sorted[i - 1])) return false;
  return true;
}

float sharpness_of(std::span<const WindowPoint> members, const Vec3f& direction, float range,
                   float radius_rad, const FeatureOptions& o) {
  if (members.size() < kFewestInWindow) return kNoSharpness;
  Vec3f mean = Vec3f::Zero();
  for (const WindowPoint& m : members) mean += m.offset;
  mean /= static_cast<float>(members.size());
  if (mean.norm() > kMaxOffCentre * radius_rad) return kNoSharpness;
  if (!is_one_surface(members, range, static_cast<float>(o.jump_m))) return kNoSharpness;

  const Vec3f across = direction.unitOrthogonal(), up = direction.cross(across);
  Eigen::Matrix3f information = Eigen::Matrix3f::Zero();
  Vec3f sums = Vec3f::Zero();
  std::array<const WindowPoint*, 2> nearest{&members[0], &members[1]};
  if (nearest[1]->distance2 < nearest[0]->distance2) std::swap(nearest[0], nearest[1]);
  for (std::size_t i = 0; i < members.size(); ++i) {
    const WindowPoint& m = members[i];
    const Vec3f row(1, m.offset.dot(across) / radius_rad, m.offset.dot(up) / radius_rad);
    information += row * row.transpose();
    sums += row * (m.range - range);
    if (i >= 2 && m.distance2 < nearest[1]->distance2) {
      nearest[1] = &m;
      if (m.distance2 < nearest[0]->distance2) std::swap(nearest[0], nearest[1]);
    }
  }
  if (!(information.determinant() > 0.01f)) return kNoSharpness;
  const Vec3f fit = information.inverse() * sums;  // a - range, and the slopes over the radius
  const float slope = fit.tail<2>().norm() / (radius_rad * range);
  if (slope * std::tan(static_cast<float>(o.min_incidence_rad)) > 1) return kNoSharpness;
  // Three points have 1 / sqrt(3) of the noise; each is compared with the fit in its own direction.
  float here = fit[0];
  for (const WindowPoint* m : nearest)
    here += fit[0] + fit[1] * m->offset.dot(across) / radius_rad + fit[2] * m->offset.dot(up) / radius_rad -
            (m->range - range);
  // A distance along the beam is longer than one along the normal by 1 / cos.
  return std::abs(here) / 3 / std::sqrt(1 + slope * slope) / (radius_rad * range);
}

/// For each cell the point of the largest value, if that is at least `least`.
std::vector<Feature> best_of_cells(const std::vector<SweepPoint>& points,
                                   const std::vector<Vec3f>& directions, const std::vector<float>& values,
                                   float cell_rad, float least) {
  std::vector<Feature> best;
  const DirectionCells cells(directions, cell_rad);
  cells.for_each_cell([&](std::size_t first, std::size_t end) {
    std::size_t at = cells.order()[first];
    for (std::size_t i = first + 1; i < end; ++i)
      if (values[cells.order()[i]] > values[at]) at = cells.order()[i];
    if (values[at] >= least) best.push_back({points[at].position, points[at].time_s});
  });
  return best;
}

}  // namespace

Features find_unordered_features(const std::vector<SweepPoint>& points, const FeatureOptions& o, int threads,
                                 double fraction) {
  std::vector<Vec3f> directions(points.size());
  std::vector<float> ranges(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    ranges[i] = points[i].position.norm();
    directions[i] = points[i].position / ranges[i];
  }
  const DirectionCells cells(directions, kCell_rad);
  std::vector<float> sharpness(points.size());
  for_each_chunk(
      points.size(), kPointsPerChunk, threads, [&](std::size_t, std::size_t first, std::size_t end) {
        Window window;
        for (std::size_t at = first; at < end; ++at) {
          const std::size_t i = cells.order()[at];
          const float radius_rad =
              std::clamp(static_cast<float>(o.window_m) / ranges[i], kMinWindow_rad, kMaxWindow_rad);
          window.gather(cells, directions, ranges, i, radius_rad);
          sharpness[i] = sharpness_of(window.members(), directions[i], ranges[i], radius_rad, o);
        }
      });

  Features out;
  std::vector<float> flatness(points.size());
  for (const std::uint32_t i : cells.order()) {  // neighbours one after another: they share voxels
    const bool has = sharpness[i] != kNoSharpness;
    flatness[i] = has ? -sharpness[i] : -std::numeric_limits<float>::infinity();
    if (has) out.surface.push_back({points[i].position, points[i].time_s});
  }
  const auto scale = static_cast<float>(1 / std::sqrt(fraction));
  out.edges = best_of_cells(points, directions, sharpness, scale * kEdgeCell_rad,
                            static_cast<float>(o.min_sharpness));
  out.planes = best_of_cells(points, directions, flatness, scale * kPlaneCell_rad,
                             -static_cast<float>(o.max_flatness));
  return out;
}

}  // namespace karst::core
