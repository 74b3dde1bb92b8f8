#include "core_stack/localization/features.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "core_stack/localization/parallel.h"

namespace karst::core {
namespace {

constexpr int kMinHalfWindow = 4, kMaxHalfWindow = 24;  // points
constexpr float kMaxGap = 2.5f;                         // beam steps between points of one segment
constexpr float kMaxSlope = 0.05f;                      // of the range, between points of one segment
constexpr float kNone = -1;                             // no sharpness

/// The median angle between neighbouring beams, from a sample of the sweep.
float beam_step(const std::vector<SweepPoint>& points) {
  std::vector<float> steps;
  for (std::size_t i = 0; i + 1 < points.size(); i += 17)
    if (points[i].ring == points[i + 1].ring) {
      const Vec3f a = points[i].position.normalized(), b = points[i + 1].position.normalized();
      steps.push_back((a - b).norm());
    }
  if (steps.empty()) return 0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// One ring and the prefix sums that its windows need.
struct Ring {
  std::span<const SweepPoint> points;
  std::vector<float> range;
  std::vector<Vec3> sum;                        // sum[i]: sum of all positions before point i
  std::vector<int> segment_begin, segment_end;  // bounds of the segment of point i

  Ring(std::span<const SweepPoint> p, float step, float jump_m) : points(p) {
    const std::size_t n = p.size();
    range.resize(n);
    sum.resize(n + 1);
    segment_begin.resize(n);
    segment_end.resize(n);
    sum[0].setZero();
    for (std::size_t i = 0; i < n; ++i) {
      range[i] = p[i].position.norm();
      sum[i + 1] = sum[i] + p[i].position.cast<double>();
    }
    for (std::size_t begin = 0, i = 1; i <= n; ++i) {
      if (i < n && !breaks_at(i, kMaxGap * step, jump_m)) continue;
      std::fill(segment_begin.begin() + begin, segment_begin.begin() + i, static_cast<int>(begin));
      std::fill(segment_end.begin() + begin, segment_end.begin() + i, static_cast<int>(i));
      begin = i;
    }
  }

  Vec3f mean(int first, int last) const {
    const Vec3 total = sum[static_cast<std::size_t>(last + 1)] - sum[static_cast<std::size_t>(first)];
    return (total / (last - first + 1)).cast<float>();
  }

 private:
  /// Whether a new segment begins at point i: the range jumps, or beams in between had no return.
  bool breaks_at(std::size_t i, float max_gap_rad, float jump_m) const {
    const float a = range[i - 1], b = range[i];
    if (std::abs(a - b) > std::max(jump_m, kMaxSlope * std::min(a, b))) return true;
    const float across2 = (points[i].position - points[i - 1].position).squaredNorm() - (a - b) * (a - b);
    return across2 > max_gap_rad * max_gap_rad * a * b;
  }
};

/// Sharpness of each point; kNone where the window leaves the segment or the beams graze the rock.
std::vector<float> sharpness_of(const Ring& ring, float step, const FeatureOptions& o) {
  const int n = static_cast<int>(ring.points.size());
  const float cos_grazing = std::cos(static_cast<float>(o.min_incidence_rad));
  std::vector<float> sharpness(ring.points.size(), kNone);
  for (int i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const float in_window = static_cast<float>(o.window_m) / (step * ring.range[at]);
    const int half = std::clamp(static_cast<int>(std::min(in_window, 1e6f)), kMinHalfWindow, kMaxHalfWindow);
    if (i - half < ring.segment_begin[at] || i + half >= ring.segment_end[at]) continue;
    const Vec3f& p = ring.points[at].position;
    const Vec3f across = ring.points[static_cast<std::size_t>(i + half)].position -
                         ring.points[static_cast<std::size_t>(i - half)].position;
    const float length = across.norm();
    if (length == 0 || std::abs(across.dot(p)) > cos_grazing * length * ring.range[at]) continue;
    // The point itself is replaced by the mean of three, which has 1 / sqrt(3) of the noise.
    sharpness[at] = 2 * (ring.mean(i - half, i + half) - ring.mean(i - 1, i + 1)).norm() / length;
  }
  return sharpness;
}

/// For each sector, the point with the largest value, if that is at least `least`.
std::vector<Feature> best_of_sectors(const Ring& ring, const std::vector<float>& values, std::int64_t sectors,
                                     float least) {
  std::vector<Feature> best;
  const auto n = static_cast<std::int64_t>(ring.points.size());
  for (std::int64_t s = 0; s < sectors; ++s) {
    const auto first = values.begin() + n * s / sectors, end = values.begin() + n * (s + 1) / sectors;
    const auto at = std::max_element(first, end);
    if (at == end || *at < least) continue;
    const SweepPoint& p = ring.points[static_cast<std::size_t>(at - values.begin())];
    best.push_back({p.position, p.time_s});
  }
  return best;
}

Features features_of(const Ring& ring, float step, const FeatureOptions& o) {
  const std::vector<float> sharpness = sharpness_of(ring, step, o);
  std::vector<float> flatness(sharpness.size());
  Features out;
  for (std::size_t i = 0; i < sharpness.size(); ++i) {
    const bool has = sharpness[i] != kNone;
    flatness[i] = has ? -sharpness[i] : -std::numeric_limits<float>::infinity();
    if (has) out.surface.push_back({ring.points[i].position, ring.points[i].time_s});
  }
  out.edges = best_of_sectors(ring, sharpness, o.edge_sectors, static_cast<float>(o.min_sharpness));
  out.planes = best_of_sectors(ring, flatness, o.plane_sectors, -static_cast<float>(o.max_flatness));
  return out;
}

}  // namespace

void describe(OptionTable& t, FeatureOptions& o) {
  t.add("window", o.window_m, "m", 0.02, 2,
        "half length along the rock of the window that tells edges from planes");
  t.add("max_flatness", o.max_flatness, "", 0, 1, "sharpness a planar feature may have at most");
  t.add("min_sharpness", o.min_sharpness, "", 0, 1, "sharpness an edge feature must have at least");
  t.add("min_incidence", o.min_incidence_rad, "rad", 0, 1.5,
        "rock at a smaller angle to the beam is not used");
  t.add("jump", o.jump_m, "m", 0.02, 5, "neighbouring ranges that differ by more belong to two surfaces");
  t.add("plane_sectors", o.plane_sectors, 1, 4096,
        "sectors of a ring, each of which gives one planar feature at most");
  t.add("edge_sectors", o.edge_sectors, 1, 4096,
        "sectors of a ring, each of which gives one edge feature at most");
}

Features find_features(const std::vector<SweepPoint>& points, const FeatureOptions& options, int threads) {
  std::vector<std::size_t> begins;  // index of the first point of each ring
  for (std::size_t i = 0; i < points.size(); ++i)
    if (i == 0 || points[i].ring != points[i - 1].ring) begins.push_back(i);
  const std::size_t rings = begins.size();
  begins.push_back(points.size());
  const float step = beam_step(points);
  if (!(step > 0)) return {};

  std::vector<Features> found(rings);
  for_each_chunk(rings, 4, threads, [&](std::size_t, std::size_t first, std::size_t end) {
    for (std::size_t r = first; r < end; ++r) {
      const Ring ring({points.data() + begins[r], begins[r + 1] - begins[r]}, step,
                      static_cast<float>(options.jump_m));
      found[r] = features_of(ring, step, options);
    }
  });
  Features all;
  const auto append = [](std::vector<Feature>& to, const std::vector<Feature>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  for (const Features& f : found) {
    append(all.edges, f.edges);
    append(all.planes, f.planes);
    append(all.surface, f.surface);
  }
  return all;
}

}  // namespace karst::core
