// Which rock of the cave itself is in the pictures: by rays into the mesh.
#pragma once
#include <span>
#include <vector>

#include "plugins/simulator/cave/ray_scene.h"
#include "sdk/evaluation/reachable/cell_set.h"
#include "sdk/evaluation/record/picture_poses.h"

namespace karst::evaluation {

/// Cells, sorted, that hold the point where a ray of some picture first meets rock, within the camera's range
/// and met at no more than its greatest incidence. A picture's rays are spread evenly over its plane,
/// half a cell apart at the camera's range. A picture from within 1 cm and 0.1 degrees of the last one looked
/// at is passed over: it shows the same.
std::vector<CellKey> imaged_rock(const cave::RayScene& scene, std::span<const PicturePose> pictures,
                                 double resolution_m);

}  // namespace karst::evaluation
