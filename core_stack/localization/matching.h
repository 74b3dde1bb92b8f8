// Correspondences between a sweep and the local map.
//
// A planar feature marks a place on a surface. The residual there does not compare the feature with a plane:
// it compares the mean of the sweep's points with the mean of the map's points, over the same window of
// voxels (see means_of), along the map's normal in that window. Comparing a feature with a plane is biased
// wherever rock is curved: a plane fitted to a window lies beside the surface by half the curvature times the
// window's variance, and the pose would drift by up to one per cent of the path. Means over the same window
// share the same bias.
//
// An edge feature is compared with the line that the map's edges form around it.
#pragma once
#include "core_stack/localization/local_map.h"

namespace karst::core {

/// A point of the sweep that belongs on the plane through `q` with normal `n1`, or, with two normals, on the
/// line in which two such planes intersect.
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
  int places = 0;  // number of candidates: edges, and voxels with a planar feature
};

/// Reusable memory; results do not depend on it.
struct Workspace {
  int threads = 1;
  Grids grids;  // of the sweep; kept to reuse their memory
};

/// Matches of a sweep at the approximate pose `T_world_body`, in surface grids `first_level` and coarser.
Matches find_matches(const Cloud& cloud_body, const LocalMap& map, const Pose& T_world_body,
                     std::size_t first_level, Workspace& workspace);

}  // namespace karst::core
