// The parts of the true rock surface that the pictures show, found by casting rays into the mesh.
#pragma once
#include <span>
#include <vector>

#include "plugins/simulator/cave/ray_scene.h"
#include "sdk/evaluation/reachable/cell_set.h"
#include "sdk/evaluation/record/picture_poses.h"

namespace karst::evaluation {

/// Cells, sorted, that contain the first hit of some picture's ray on rock, if the hit is within the camera's
/// range and at most at its greatest incidence. The rays of a picture are evenly spaced on its image plane,
/// half a cell apart at the camera's range. A picture within 1 cm and 0.1 degrees of the last one used is
/// skipped, because it shows the same.
std::vector<CellKey> imaged_rock(const cave::RayScene& scene, std::span<const PicturePose> pictures,
                                 double resolution_m);

}  // namespace karst::evaluation
