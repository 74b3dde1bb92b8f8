// A loop closure: two submaps that show the same rock, and the pose of one in the other.
#pragma once
#include <string>

#include "core_stack/common/options.h"
#include "core_stack/localization/registration.h"
#include "core_stack/loops/submap.h"

namespace karst::core {

struct ClosureLimits {
  double overlap_radius_m = 10;  // rock nearer than this to the place must coincide
  double min_overlap = 0.7;      // of the rock there, in both directions
  double max_residual_m = 0.15;  // root mean square, with robust weights
  double min_hold = 0.015;     // mean squared cosine of the least constrained direction to the rock's normals
  double max_tilt_rad = 0.05;  // between the vertical axes
  double min_clearance_m = 0.3;  // of one's flown path from the other's rock
  double max_rival = 0.85;       // overlap of another pose that also fits, divided by the best one's
};
void describe(OptionTable& t, ClosureLimits& o);

struct Closure {
  std::size_t older = 0, newer = 0;  // submaps
  Pose T_older_newer;
  Matrix6 covariance = Matrix6::Identity();  // translation (older frame, m), rotation (newer frame, rad)
  double overlap = 0;                        // the smaller one of both directions
  double residual_m = 0;
  double hold = 0;      // see ClosureLimits
  std::string problem;  // why it is not credible; empty if it is
};

/// A submap made ready for registration.
class SubmapRock {
 public:
  SubmapRock(const Submap& submap, double voxel_m);
  const Submap& submap() const { return submap_; }
  const PointTree& tree() const { return tree_; }
  const LocalMap& map() const { return map_; }

 private:
  const Submap& submap_;
  PointTree tree_;
  LocalMap map_;
};

/// Registers `newer` in `older`, from far to near, and looks at the result: enough rock near the place must
/// coincide, seen from either side; little may remain; the rock must hold the pose in all directions, as a
/// smooth tube does not; both know where up is; and nobody flew through rock.
Closure registered(const SubmapRock& older, const SubmapRock& newer, const Pose& T_older_newer,
                   const ClosureLimits& limits, Workspace& workspace);

}  // namespace karst::core
