#include "core_stack/localization/features.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core_stack/localization/parallel.h"

namespace karst::core {
namespace {

constexpr int kMinHalfWindow = 4, kMaxHalfWindow = 24;  // points
constexpr float kNone = -1;                             // no sharpness

/// The usual angle between neighbouring beams, from a sample of the sweep.
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

/// One ring with what every step below asks for.
struct Ring {
  std::span<const SweepPoint> points;
  std::vector<float> range;
  std::vector<Vec3> sum;         // sum[i]: of all positions before i
  std::vector<int> segment_end;  // of the segment that point i is in

  Ring(std::span<const SweepPoint> p, float step, const FeatureOptions& o) : points(p) {
    const auto n = p.size();
    range.resize(n), sum.resize(n + 1), segment_end.resize(n);
    sum[0].setZero();
    for (std::size_t i = 0; i < n; ++i) {
      range[i] = p[i].position.norm();
      sum[i + 1] = sum[i] + p[i].position.cast<double>();
    }
    const float max_gap = 2.5f * step;
    int end = static_cast<int>(n);
    for (int i = static_cast<int>(n) - 1; i >= 0; --i) {
      segment_end[static_cast<std::size_t>(i)] = end;
      if (i > 0 && breaks(static_cast<std::size_t>(i), max_gap, static_cast<float>(o.jump_m))) end = i;
    }
  }

  /// A new segment begins at point i.
  bool breaks(std::size_t i, float max_gap, float jump_m) const {
    const float a = range[i - 1], b = range[i], near = std::min(a, b);
    if (std::abs(a - b) > std::max(jump_m, 0.05f * near)) return true;
    const float chord2 = (points[i].position - points[i - 1].position).squaredNorm() - (a - b) * (a - b);
    return chord2 > max_gap * max_gap * a * b;
  }
};

struct Choice {
  int index = -1;
  float sharpness = 0;
};

struct RingFeatures {
  std::vector<Feature> edges, planes;
  std::vector<std::uint32_t> surface;
};

RingFeatures features_of_ring(const Ring& ring, std::uint32_t first_index, float step,
                              const FeatureOptions& o) {
  RingFeatures out;
  const int n = static_cast<int>(ring.points.size());
  std::vector<float> sharpness(static_cast<std::size_t>(n), kNone);
  std::vector<Vec3f> mean(static_cast<std::size_t>(n));
  const float cos_grazing = std::cos(static_cast<float>(o.min_incidence_rad));
  int segment_begin = 0;
  for (int i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (i > 0 && ring.segment_end[at] != ring.segment_end[at - 1]) segment_begin = i;
    const int half = std::clamp(static_cast<int>(static_cast<float>(o.window_m) / (step * ring.range[at])),
                                kMinHalfWindow, kMaxHalfWindow);
    const int low = i - half, high = i + half;
    if (low < segment_begin || high >= ring.segment_end[at]) continue;
    const auto l = static_cast<std::size_t>(low), h = static_cast<std::size_t>(high);
    const Vec3f across = ring.points[h].position - ring.points[l].position;
    const float length = across.norm();
    const Vec3f& p = ring.points[at].position;
    if (std::abs(across.dot(p)) > cos_grazing * length * ring.range[at]) continue;
    mean[at] = ((ring.sum[h + 1] - ring.sum[l]) / (2 * half + 1)).cast<float>();
    // The point itself, less noisy, as the mean of it and its neighbours.
    const Vec3f centre = ((ring.sum[at + 2] - ring.sum[at - 1]) / 3).cast<float>();
    sharpness[at] = 2 * (mean[at] - centre).norm() / length;
    out.surface.push_back(first_index + static_cast<std::uint32_t>(i));
  }

  const auto pick = [&](std::int64_t sectors, auto better, auto&& keep) {
    for (std::int64_t s = 0; s < sectors; ++s) {
      Choice best;
      for (auto i = static_cast<int>(n * s / sectors); i < static_cast<int>(n * (s + 1) / sectors); ++i) {
        const float v = sharpness[static_cast<std::size_t>(i)];
        if (v != kNone && (best.index < 0 || better(v, best.sharpness))) best = {i, v};
      }
      if (best.index >= 0) keep(best);
    }
  };
  pick(
      o.plane_sectors, [](float a, float b) { return a < b; },
      [&](const Choice& c) {
        const auto i = static_cast<std::size_t>(c.index);
        if (c.sharpness <= static_cast<float>(o.max_flatness))
          out.planes.push_back({mean[i], ring.points[i].time_s});
      });
  pick(
      o.edge_sectors, [](float a, float b) { return a > b; },
      [&](const Choice& c) {
        const auto i = static_cast<std::size_t>(c.index);
        if (c.sharpness >= static_cast<float>(o.min_sharpness))
          out.edges.push_back({ring.points[i].position, ring.points[i].time_s});
      });
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
  std::vector<std::size_t> begins;  // of rings
  for (std::size_t i = 0; i < points.size(); ++i)
    if (i == 0 || points[i].ring != points[i - 1].ring) begins.push_back(i);
  const std::size_t rings = begins.size();
  begins.push_back(points.size());
  const float step = beam_step(points);
  Features all;
  if (step <= 0) return all;

  std::vector<RingFeatures> found(rings);
  for_each_chunk(rings, 4, threads, [&](std::size_t, std::size_t first, std::size_t end) {
    for (std::size_t r = first; r < end; ++r) {
      const Ring ring({points.data() + begins[r], begins[r + 1] - begins[r]}, step, options);
      found[r] = features_of_ring(ring, static_cast<std::uint32_t>(begins[r]), step, options);
    }
  });
  for (const RingFeatures& f : found) {
    all.edges.insert(all.edges.end(), f.edges.begin(), f.edges.end());
    all.planes.insert(all.planes.end(), f.planes.begin(), f.planes.end());
    all.surface.insert(all.surface.end(), f.surface.begin(), f.surface.end());
  }
  return all;
}

}  // namespace karst::core
