// The sign of normals: they are to point into the air.
#pragma once
#include <cstddef>
#include <vector>

#include "sdk/cave_from_cloud/normals.h"

namespace karst::from_cloud {

struct Orientation {
  std::size_t seen = 0;              // points whose sign a view decided
  std::size_t rays = 0, agreed = 0;  // that voted on the sign of the others, and for the sign chosen
};

/// Turns each normal to the side from which its point was measured.
///
/// - The normal of a point that one of the `views` (places of the scanner) sees points to the nearest of
///   them. A view sees a point at most 50 m away if the line between them passes no point nearer than the
///   spacing, except at its end.
/// - From there, or from anywhere if there is no view, the sign passes on from neighbour to neighbour along a
///   minimum spanning tree, whose edges cost the more the more the normals differ (Hoppe et al., Surface
///   Reconstruction from Unorganized Points, 1992).
/// - The sign of a tree without a view is put to the vote: from its points, rays are cast both ways along
///   the normal. In a cave rock lies opposite; behind the wall there is mostly nothing within 30 m.
///
/// The points of the tree are about `spacing_m` apart.
Orientation orient(const core::PointTree& tree, const Neighbours& neighbours,
                   const std::vector<core::Vec3>& views, double spacing_m, std::vector<core::Vec3f>& normals);

}  // namespace karst::from_cloud
