// Where one flight's map lies in another's, or a reason why that cannot be trusted. docs/map_merge.md
//
//   places that look alike --> 150 poses --few steps of ICP--> 8 --ICP--> the best and its rivals --> a
//   verdict
//
// ICP ends somewhere from everywhere. What makes an end believable is asked of the maps: enough rock lies on
// rock, little stands in space the other flight flew through or saw through, the rock that coincides holds
// the pose in every direction, and no other pose is nearly as good.
#pragma once
#include <string>

#include "core_stack/common/options.h"
#include "sdk/map_merge/coarse_match.h"
#include "sdk/map_merge/icp.h"
#include "sdk/map_merge/map_overlay.h"

namespace karst::map_merge {

struct RegistrationLimits {
  double min_overlap = 0.17;  // of the rock of the map that shares more; half as much again without gravity
  double min_overlap_blind = 0.35;   // where no free space is known
  double min_shared_m2 = 25;         // rock that coincides
  double min_agreement = 0.985;      // of the rock the other map can judge
  double max_residual_cells = 0.75;  // in cells of the coarser map
  double min_hold = 0.015;           // of the least held direction
  double max_rival = 0.75;           // score of the next best pose over the best's
  double max_tilt_rad = 0.026;       // with gravity known
};
void describe(core::OptionTable& t, RegistrationLimits& o);

struct MapRegistrationOptions {
  CoarseOptions coarse;
  std::vector<IcpRound> quick = {{2.0, 8, 600}, {1.0, 8, 600}};
  std::vector<IcpRound> thorough = {{1.0, 20, 3000}, {0.4, 30, 6000}};
  std::size_t finalists = 8;
  OverlayOptions overlay;
  RegistrationLimits limits;
};

struct MapRegistration {
  core::Pose T_target_source;
  Overlay overlay;
  double hold = 0;   // mean squared cosine of the least held direction to the coinciding rock's normals
  double rival = 0;  // score of the best pose that is another, over this one's
  double shared_m2 = 0;
  bool trusted = false;
  std::string reason;  // why not
};

MapRegistration register_maps(const MapPiece& target, const MapPiece& source,
                              const MapRegistrationOptions& options);

/// How well the rock that coincides holds the pose: over the near points with normal n and arm p from their
/// middle, the least eigenvalue of the mean of j j', j = (n, p x n / L), L the arms' root mean square; with
/// gravity known only the turn about z counts. 0: free in some direction, as along a smooth tube.
double hold_of(const MapPiece& target, const MapPiece& source, const core::Pose& T_target_source,
               double near_m, bool gravity_known);

}  // namespace karst::map_merge
