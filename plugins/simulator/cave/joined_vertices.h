// Vertices at the same position count as one.
#pragma once
#include <cstdint>
#include <vector>

#include "plugins/simulator/cave/triangle_mesh.h"

namespace karst::cave {

/// For each vertex the least number of those at its position.
std::vector<std::uint32_t> first_at_position(const TriangleMesh& mesh);

}  // namespace karst::cave
