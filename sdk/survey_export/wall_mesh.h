// The walls of a map as a mesh: the surface between free and occupied cells.
#pragma once
#include <string>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "plugins/simulator/cave/triangle_mesh.h"

namespace karst::survey_export {

struct WallMesh {
  cave::TriangleMesh mesh;           // wound counter-clockwise as seen from the cave
  std::vector<core::Vec3f> normals;  // of the vertices, into the cave
  std::size_t open_edges = 0;        // edges of one triangle only: where the seen rock ends
};

/// A surface net (Gibson, Constrained elastic surface nets, 1998): two triangles for each face of a cell that
/// a free and an occupied cell share, with a vertex for each corner where they meet, in the mean of the
/// middles of the shared faces around it. Closed but for where free cells meet unknown space. The rock's
/// surface lies half a cell behind it on average.
WallMesh wall_mesh(const core::VoxelMap& map);

/// A binary PLY with normals and faces.
std::string ply_bytes(const WallMesh& walls);

}  // namespace karst::survey_export
