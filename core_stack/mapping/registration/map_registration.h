// Registers one flight's map in another's, or gives a reason why no pose can be trusted. docs/map_merge.md,
// docs/earlier_map.md
//
//   similar places --> 12 poses --a few steps of ICP--> 8 --ICP--> the best and its rivals --> a
//   verdict
//
// Who can refine a pose within the cells gives a FinishPose, which ends the ICP of the 8.
//
// ICP converges from every start. The maps decide whether a result is credible: enough rock coincides, little
// rock lies in space that the other flight observed as free, the coinciding rock constrains the pose in every
// direction, and no other pose is nearly as good.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/common/options.h"
#include "core_stack/mapping/registration/coarse_match.h"
#include "core_stack/mapping/registration/map_overlay.h"

namespace karst::core {

/// One stage of ICP: pairs points up to `correspondence_m` apart, with an even sample of the source's points.
struct IcpRound {
  double correspondence_m;
  int iterations;
  std::size_t max_points;
};

/// ICP of the source in a target that it knows: the pose T_target_source at which it ends, which may be
/// wrong.
using RefinePose =
    std::function<Pose(const MapPiece& source, const Pose& T_target_source, const std::vector<IcpRound>&)>;

/// The pose at the end of a registration on the rock's surface rather than on cells (rock_surface.h), and the
/// root mean square distance of the surfaces that remains.
struct FinishedPose {
  Pose T_target_source;
  double surface_residual_m = 0;
};
using FinishPose = std::function<FinishedPose(const Pose& T_target_source)>;

struct RegistrationLimits {
  double min_overlap = 0.17;                // of the map that shares more rock; times 1.5 without gravity
  double min_overlap_blind = 0.35;          // if no free space is known
  double min_shared_m2 = 25;                // area of the rock that coincides
  double min_agreement = 0.985;             // of the rock in space known to the other map
  double max_residual_cells = 0.75;         // in cells of the coarser map
  double max_surface_residual_cells = 0.3;  // of the finished pose, if it was finished
  double min_hold = 0.015;                  // of the least constrained direction
  double max_rival = 0.75;                  // score of the next best pose divided by the best one
  double max_tilt_rad = 0.026;              // if gravity is known
};
void describe(OptionTable& t, RegistrationLimits& o);

struct MapRegistrationOptions {
  CoarseOptions coarse;
  std::vector<IcpRound> quick = {{2.0, 8, 600}, {1.0, 8, 600}};
  std::vector<IcpRound> thorough = {{1.0, 20, 3000}, {0.4, 30, 6000}};
  std::size_t finalists = 8;
  OverlayOptions overlay;
  RegistrationLimits limits;
};

struct MapRegistration {
  Pose T_target_source;
  Overlay overlay;
  std::optional<double> surface_residual_m = {};  // if the pose was finished
  double hold = 0;  // mean squared cosine of the least constrained direction to the common rock's normals
  // Score of the best different pose divided by this one's; poses that their own surface residual refutes are
  // left out.
  double rival = 0;
  double shared_m2 = 0;
  bool trusted = false;
  std::string reason;  // reason for the rejection
};

MapRegistration register_maps(const MapPiece& target, const MapPiece& source,
                              const MapRegistrationOptions& options, const RefinePose& refine,
                              const FinishPose& finish = {});

/// How well the common rock constrains the pose: over near points with normal n and arm p from their middle,
/// the least eigenvalue of the mean of j j', j = (n, p x n / L), L the arms' root mean square; with known
/// gravity only the turn about z counts. 0: free in some direction, as in a smooth tube.
double hold_of(const MapPiece& target, const MapPiece& source, const Pose& T_target_source, double near_m,
               bool gravity_known);

}  // namespace karst::core
