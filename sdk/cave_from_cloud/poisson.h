// Poisson surface reconstruction with PCL (Kazhdan and Hoppe, Screened Poisson Surface Reconstruction, 2013).
#pragma once
#include "plugins/simulator/cave/triangle_mesh.h"
#include "sdk/cave_from_cloud/point_cloud.h"

namespace karst::from_cloud {

/// False if karst was built without PCL: then poisson_surface() throws.
bool has_poisson();

constexpr int kDeepest = 12;      // levels of the octree; beyond it single precision is too coarse
constexpr double kMargin = 1.25;  // least ratio of the octree's edge to the cloud's
/// Extent of the longest side that the octree can hold in cells of this size.
constexpr double longest_side_m(double cell_m) { return cell_m * (1 << kDeepest) / kMargin; }

/// A closed surface through points with normals, or one with holes where the octree ends. The finest cells of
/// the octree have the edge `cell_m`. Coordinates are those of the cloud: its origin is not added. The
/// triangles face the side of the normals. The same bytes for the same cloud: one thread.
cave::TriangleMesh poisson_surface(const PointCloud& cloud, double cell_m);

}  // namespace karst::from_cloud
