// Candidate poses of one map in another, without prior knowledge except, perhaps, gravity: similar places.
#pragma once
#include "core_stack/mapping/registration/map_piece.h"
#include "core_stack/mapping/registration/place_descriptor.h"

namespace karst::core {

struct CoarseOptions {
  bool gravity_known = true;  // both maps' z axes point up
  double spacing_m = 1.0;     // between places of the target; wider in a very large map
  std::size_t max_target_places = 12000, max_source_places = 500;
  std::vector<double> cells_m = {
      1.0, 0.6};               // of descriptors: wide ones say more, small ones fit into less overlap
  std::size_t candidates = 8;  // number of target places tried for each source place
  std::size_t kept = 12;       // number of poses returned
  double distinct_m = 2.0, distinct_rad = 0.25;  // poses nearer to each other count as one
};

struct CoarsePose {
  Pose T_target_source;
  double score;   // by RoughTarget
  int votes = 1;  // number of matches that imply this pose
};

/// Distinct poses; deterministic. Every match of a place with a candidate implies a pose of the whole map;
/// each is scored on the maps as a whole. Half of the returned poses have the best scores, the other half the
/// most votes among the rest: a few correct matches among thousands suffice.
std::vector<CoarsePose> coarse_poses(const MapPiece& target, const MapPiece& source,
                                     const CoarseOptions& options);

/// Whether two poses differ by less than the limits in the displacement of the map's middle and in rotation.
bool alike(const Pose& a, const Pose& b, const Vec3& middle, double metres, double radians);

}  // namespace karst::core
