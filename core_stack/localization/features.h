// Features of a sweep for matching: the sharpest and the flattest points of each ring, following LOAM (Zhang
// and Singh, RSS 2014).
//
// A ring is cut into segments of one surface: a new segment begins where the sensor got no return between
// two points, or where their ranges jump (the nearer surface occludes the farther one). The window around
// point i contains neighbours from the same segment; its length along the rock is about the same at any
// range, and
//   sharpness_i = |mean of the window - p_i| / half the window's length
//
// is 0 on a plane and 0.35 at the tip of a right angle. A point has no sharpness if its window would leave
// its segment: at an occlusion a surface only seems to end, and its silhouette moves with the viewer. Grazing
// beams give no sharpness either, because the range noise would look like shape.
//
// Each ring is divided into sectors. At most the flattest and the sharpest points of each sector become
// features, so that features are spread all around.
#pragma once
#include "core_stack/common/options.h"
#include "core_stack/localization/sweep.h"

namespace karst::core {

struct FeatureOptions {
  double window_m = 0.25;           // half length of the window along the rock
  double max_flatness = 0.08;       // greatest sharpness of a planar feature
  double min_sharpness = 0.2;       // least sharpness of an edge feature
  double min_incidence_rad = 0.17;  // between beam and surface
  double jump_m = 0.07;             // a larger range jump, a few times the noise, begins a new surface
  std::int64_t plane_sectors = 48;  // number per ring
  std::int64_t edge_sectors = 12;   // number per ring
};
void describe(OptionTable& t, FeatureOptions& o);

/// A feature point of the sweep.
struct Feature {
  Vec3f position;  // lidar frame at the time it was measured
  float time_s;
};

struct Features {
  std::vector<Feature> edges, planes;
  std::vector<Feature> surface;  // all points that have a sharpness
};

/// Points must be finite and sorted by ring, as in a Sweep. `threads` affects the run time, not the result.
Features find_features(const std::vector<SweepPoint>& points, const FeatureOptions& options, int threads);

}  // namespace karst::core
