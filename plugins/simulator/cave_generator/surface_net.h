// The surface between rock and free space as triangles.
#pragma once
#include "plugins/simulator/cave/triangle_mesh.h"
#include "plugins/simulator/cave_generator/samples.h"

namespace karst::cave {

/// Naive surface nets (Gibson, 1998): a vertex in each cell that the surface passes, at the mean of its
/// crossings of the cell's edges; a quadrilateral, split into two triangles, for each grid edge it crosses.
/// Normals point into the cave. Closed, and a manifold if the samples' sheets are separate: every edge
/// belongs to two triangles that run along it in opposite directions.
TriangleMesh surface_net(const Samples& s);

}  // namespace karst::cave
