// A mesh falls into parts that share no vertex: the cave, stones in its air, bubbles in the rock.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "plugins/simulator/cave/triangle_mesh.h"

namespace karst::from_cloud {

struct MeshParts {
  std::size_t count = 0;
  std::vector<std::uint32_t> of_triangle;  // number of the part, in the order of their first triangles
};
MeshParts parts_of(const cave::TriangleMesh& mesh);

/// The triangles of one part, and their vertices.
cave::TriangleMesh part_of(const cave::TriangleMesh& mesh, const MeshParts& parts, std::uint32_t part);

/// How often each part winds around a place: the sum of its triangles' solid angles over 4 pi. 1 or -1 inside
/// a closed surface, 0 outside, and in between where it has holes (Jacobson et al., Robust Inside-Outside
/// Segmentation using Generalized Winding Numbers, 2013).
std::vector<double> winding_numbers(const cave::TriangleMesh& mesh, const MeshParts& parts,
                                    const core::Vec3& place);

double area_m2(const cave::TriangleMesh& mesh, std::size_t triangle);

}  // namespace karst::from_cloud
