// The volume inside a mesh.
#pragma once
#include "plugins/simulator/cave/triangle_mesh.h"

namespace karst::cave {

/// Volume enclosed by a closed mesh whose normals point inwards (divergence theorem).
double enclosed_volume_m3(const TriangleMesh& mesh);

}  // namespace karst::cave
