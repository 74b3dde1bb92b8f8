// What helps with a cave that is refused.
#pragma once
#include <optional>
#include <string>

#include "plugins/simulator/cave/mesh_frame.h"
#include "plugins/simulator/cave/ray_scene.h"

namespace karst::cave {

/// Continues the sentence of a refusal: what mesh_advice() finds or, if that is nothing, a start that suits,
/// unless `start` is in the air of the cave itself. "" if nothing is known to help.
std::string remedies(const RayScene& scene, const MeshFrame& frame, const std::optional<core::Vec3>& start);

}  // namespace karst::cave
