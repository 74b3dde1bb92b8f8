// Correspondences between a sweep and the local map.
//
// A planar feature marks a place on a surface. What is compared there is not the feature with a plane, but
// the sweep's points with the map's, both as means over the same window of voxels (see means_of), along the
// normal that the map's points have in it. A feature against a plane is biased wherever rock is curved: a
// plane fitted to a window lies beside the surface by half the curvature times the window's variance, and a
// pose estimated from it drifts by up to one per cent of the path. Means over the same window have the same
// bias.
//
// An edge feature is compared with the line that the map's edges form around it.
#pragma once
#include "core_stack/localization/local_map.h"

namespace karst::core {

/// A point of the sweep belongs on the plane through `q` with normal `n1`, or, with two normals, on the line
/// where two such planes meet.
struct Match {
  Vec3 p = Vec3::Zero();                      // body frame
  Vec3 q = Vec3::Zero();                      // world
  Vec3 n1 = Vec3::Zero(), n2 = Vec3::Zero();  // world, unit, perpendicular
  int normals = 0;                            // 1: plane, 2: line
  double variance_m2 = 0;                     // of the distance
};

struct Matches {
  std::vector<Match> all;  // edges first
  int edges = 0, planes = 0;
  int places = 0;  // that were looked for: edges and voxels with a planar feature
};

/// What the work is done with; results do not depend on it.
struct Workspace {
  int threads = 1;
  Grids grids;  // of the sweep: kept for their memory
};

/// Matches of a sweep seen from about `T_world_body`, in surfaces of `first_level` and coarser.
Matches find_matches(const Cloud& cloud_body, const LocalMap& map, const Pose& T_world_body,
                     std::size_t first_level, Workspace& workspace);

}  // namespace karst::core
