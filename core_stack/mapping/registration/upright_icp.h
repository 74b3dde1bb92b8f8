// Iterative closest point, point to plane, of two maps whose z axes point up: four degrees of freedom.
#pragma once
#include "core_stack/mapping/registration/map_registration.h"

namespace karst::core {

/// The pose T_target_source at which the rounds end, which may be wrong. It differs from the given one by a
/// turn about z and a displacement only: a tilt that rock seen from one place suggests is less well known
/// than the vertical of two flights.
///
/// Chen and Medioni 1992: Gauss-Newton on the distances from each point to the plane of its nearest
/// neighbour. Pairs whose normals differ by more than 60 degrees are the two sides of something thin, and do
/// not count.
Pose upright_icp(const MapPiece& target, const MapPiece& source, const Pose& T_target_source,
                 const std::vector<IcpRound>& rounds);

}  // namespace karst::core
