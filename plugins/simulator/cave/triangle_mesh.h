// A cave's rock surface: triangles in metres, z up. Winding is arbitrary and the surface may have gaps.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core_stack/common/geometry.h"
#include "plugins/simulator/cave/mesh_frame.h"

namespace karst::cave {

struct TriangleMesh {
  std::vector<core::Vec3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Reads .stl, .ply, .obj or .dae: all parts of the file joined into one mesh, its node transforms applied.
/// STL, PLY and OBJ are taken in the given frame; Collada files state their unit and axis and are converted
/// to metres with z up before the frame's scale and offset apply. The offset is subtracted in double
/// precision. Throws InputError on a file that is missing, truncated, empty, no mesh, or has a vertex that is
/// not finite, more than 100 km from the origin, or was rounded to floats that far from it. Triangles without
/// area are dropped.
TriangleMesh load_mesh(const std::string& path, const MeshFrame& frame = {});
inline TriangleMesh load_mesh(const MeshFile& file) { return load_mesh(file.path, file.frame); }

/// Writes a binary .ply, or a binary .stl if the path ends in .stl. Throws InputError if it cannot.
void write_mesh(const std::string& path, const TriangleMesh& mesh);

/// Throws InputError if a .stl or .ply file is shorter than its own header states, in cases where an importer
/// would silently ignore the missing data.
void check_declared_size(const std::string& path);

/// The extension of the file's name in small letters, with its dot.
std::string lower_extension(const std::string& path);

}  // namespace karst::cave
