#include "core_stack/planning/path/elastic_band.h"

#include <algorithm>
#include <cmath>

namespace karst::core {
namespace {

constexpr int kSweeps = 60;
constexpr double kSettled_m = 0.002;  // the iteration ends when no point moves farther than this
constexpr double kBending = 0.35, kTension = 0.08, kPush = 0.3;
constexpr double kMaxStep_m = 0.15;

/// True if every point between a and b is clear, given the distances at both: no obstacle on the segment can
/// be nearer than (da + db - length) / 2. Reads the cells only if this bound does not decide.
bool surely_clear(const FreeTiles& free, const Vec3& a, double da, const Vec3& b, double db,
                  double clearance_m) {
  return da + db - (b - a).norm() >= 2 * clearance_m || free.segment_clear(a, b, clearance_m);
}

/// Nearest obstacles of points that move in small steps. Each query searches a little farther than requested,
/// which bounds how far a point may move before the next query. The results equal FreeTiles::nearest.
class NearestAlong {
 public:
  NearestAlong(const FreeTiles& free, double limit_m, std::size_t points)
      : free_(free), limit_m_(limit_m), seen_(points) {}

  NearestObstacle at(std::size_t i, const Vec3& p) {
    Seen& s = seen_[i];
    if (s.distance_m - (p - s.from).norm() >= limit_m_ + 1e-9) return {limit_m_, p};
    if (s.near && (p - s.from).norm() < 0.5 * kAhead_m) return free_.nearest(p, limit_m_);
    const NearestObstacle o = free_.nearest(p, limit_m_ + kAhead_m);
    s = {o.distance_m, p, o.distance_m < limit_m_ + kMinAhead_m};
    return o.distance_m < limit_m_ ? o : NearestObstacle{limit_m_, p};
  }

 private:
  static constexpr double kAhead_m = 0.6, kMinAhead_m = 0.1;
  struct Seen {
    double distance_m = 0;  // to the nearest obstacle, or the search radius
    Vec3 from = Vec3::Zero();
    bool near = false;  // too near to an obstacle for a larger search radius to pay off
  };
  const FreeTiles& free_;
  double limit_m_;
  std::vector<Seen> seen_;
};

}  // namespace

std::vector<Vec3> smooth_band(const FreeTiles& free, double clearance_m, double preferred_m,
                              std::vector<Vec3> points) {
  if (points.size() < 3) return points;
  const std::size_t last = points.size() - 1;
  std::vector<NearestObstacle> obstacle;
  NearestAlong nearest(free, preferred_m, points.size());
  for (std::size_t i = 0; i <= last; ++i) obstacle.push_back(nearest.at(i, points[i]));
  const auto clear_between = [&](const Vec3& a, const NearestObstacle& oa, const Vec3& b,
                                 const NearestObstacle& ob) {
    return surely_clear(free, a, oa.distance_m, b, ob.distance_m, clearance_m);
  };

  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double most = 0;
    for (std::size_t i = 1; i < last; ++i) {
      const Vec3 &p = points[i], &before = points[i - 1], &after = points[i + 1];
      const Vec3 middle = 0.5 * (before + after);
      // Position that minimizes the sum of squared second differences; at the ends tension alone.
      const Vec3 bent =
          i > 1 && i + 1 < last ? Vec3((4 * (before + after) - points[i - 2] - points[i + 2]) / 6) : middle;
      Vec3 step = kBending * (bent - p) + kTension * (middle - p);
      const NearestObstacle& o = obstacle[i];
      if (o.distance_m < preferred_m && o.distance_m > 1e-6) {
        Vec3 push = (p - o.center) / o.distance_m * (kPush * (preferred_m - o.distance_m));
        const Vec3 along = (after - before).normalized();
        push -= push.dot(along) * along;
        step += push;
      }
      if (step.norm() > kMaxStep_m) step *= kMaxStep_m / step.norm();
      if (step.norm() < 1e-4) continue;
      for (int half = 0; half < 2; ++half, step *= 0.4) {
        const Vec3 q = p + step;
        const NearestObstacle oq = nearest.at(i, q);
        if (oq.distance_m < std::min(clearance_m, o.distance_m) || !free.at(free.key_of(q))) continue;
        if ((!clear_between(before, obstacle[i - 1], q, oq) &&
             clear_between(before, obstacle[i - 1], p, o)) ||
            (!clear_between(q, oq, after, obstacle[i + 1]) && clear_between(p, o, after, obstacle[i + 1])))
          continue;
        points[i] = q;
        obstacle[i] = oq;
        most = std::max(most, step.norm());
        break;
      }
    }
    if (most < kSettled_m) break;
  }
  return points;
}

std::vector<Vec3> fine_curve(const FreeTiles& free, double clearance_m, const std::vector<Vec3>& points,
                             double spacing_m) {
  if (points.size() < 2) return points;
  std::vector<Vec3> out{points.front()};
  const std::size_t last = points.size() - 1;
  for (std::size_t i = 0; i < last; ++i) {
    const Vec3 &b = points[i], &c = points[i + 1];
    const Vec3 a = i > 0 ? points[i - 1] : Vec3(2 * b - c),
               d = i + 1 < last ? points[i + 2] : Vec3(2 * c - b);
    const int n = std::max(1, static_cast<int>(std::ceil((c - b).norm() / spacing_m - 1e-9)));
    std::vector<Vec3> curve, straight;
    for (int k = 1; k <= n; ++k) {
      const double t = static_cast<double>(k) / n;
      straight.push_back(b + (c - b) * t);
      curve.push_back(0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t +
                             (3 * b - a - 3 * c + d) * t * t * t));
    }
    bool clear = true;
    for (int k = 0; k < n && clear; ++k)
      clear = free.segment_clear(k == 0 ? b : curve[static_cast<std::size_t>(k - 1)],
                                 curve[static_cast<std::size_t>(k)], clearance_m);
    const std::vector<Vec3>& piece = clear ? curve : straight;
    out.insert(out.end(), piece.begin(), piece.end());
    out.back() = c;
  }
  return out;
}

}  // namespace karst::core
