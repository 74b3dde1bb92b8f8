// Features of a sweep for matching: the sharpest and the flattest points of each ring, after LOAM (Zhang and
// Singh, RSS 2014).
//
// A ring is cut into segments of one surface: where the sensor got no return between two points, or where
// their ranges jump (the nearer surface hides the farther one), a new segment begins. Around point i the
// points within a window of the same segment are taken, about as long on the rock at any range, and
//
//   sharpness_i = |mean of the window - p_i| / half the window's length
//
// is 0 on a plane and 0.35 at the tip of a right angle. A window that would leave its segment has no
// sharpness: at the border of an occlusion a surface only seems to end, and its silhouette moves with the
// viewer. Nor has one that the beams graze: there the noise of a range is the shape that is seen.
//
// Each ring is divided into sectors, and each sector gives the flattest and the sharpest of its points at
// most, so that features are spread all around.
#pragma once
#include "core_stack/common/options.h"
#include "core_stack/localization/sweep.h"

namespace karst::core {

struct FeatureOptions {
  double window_m = 0.25;           // half length of the window along the rock
  double max_flatness = 0.08;       // sharpness a planar feature may have
  double min_sharpness = 0.2;       // sharpness an edge feature needs
  double min_incidence_rad = 0.17;  // between beam and rock
  double jump_m = 0.07;             // of the range, a few times its noise: a new surface begins
  std::int64_t plane_sectors = 48;  // a ring
  std::int64_t edge_sectors = 12;   // a ring
};
void describe(OptionTable& t, FeatureOptions& o);

/// A point of the sweep.
struct Feature {
  Vec3f position;  // lidar frame when measured
  float time_s;
};

struct Features {
  std::vector<Feature> edges, planes;
  std::vector<Feature> surface;  // every point that has a sharpness
};

/// Points must be finite and by ring, as in a Sweep. `threads` changes the time it takes, not the result.
Features find_features(const std::vector<SweepPoint>& points, const FeatureOptions& options, int threads);

}  // namespace karst::core
