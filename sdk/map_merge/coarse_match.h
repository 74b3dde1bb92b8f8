// Where one map may lie in another, with nothing known but, perhaps, which way is up: places that look alike.
#pragma once
#include "sdk/map_merge/place_descriptor.h"

namespace karst::map_merge {

struct CoarseOptions {
  bool gravity_known = true;  // both maps' z axes point up
  double spacing_m = 1.0;     // between places of the target; wider in a very large map
  std::size_t max_target_places = 12000, max_source_places = 500;
  std::vector<double> cells_m = {
      1.0, 0.6};               // of descriptors: wide ones say more, small ones fit into less overlap
  std::size_t candidates = 8;  // places of the target looked at for each of the source
  std::size_t kept = 12;       // poses handed on
  double distinct_m = 2.0, distinct_rad = 0.25;  // poses nearer to each other count as one
};

struct CoarsePose {
  core::Pose T_target_source;
  double score;   // of RoughTarget
  int votes = 1;  // matches that say the same
};

/// No two alike; the same every time. Every match of a place with a candidate is a pose of the whole map; all
/// are scored on the maps as a whole. Half of those kept score best, half have the most votes of the rest: a
/// few right matches among thousands do.
std::vector<CoarsePose> coarse_poses(const MapPiece& target, const MapPiece& source,
                                     const CoarseOptions& options);

/// How far two poses of a map move its middle, and turn it, against each other.
bool alike(const core::Pose& a, const core::Pose& b, const core::Vec3& middle, double metres, double radians);

}  // namespace karst::map_merge
