// Subtracts an offset from the vertices of a mesh file's bytes, in double precision.
//
// The importer keeps coordinates in single precision: of UTM coordinates, millions of metres, it keeps half a
// metre. So the offset is subtracted before it reads the file.
#pragma once
#include <string>

#include "plugins/simulator/cave/mesh_frame.h"

namespace karst::cave {

/// The bytes of a .stl, .ply or .obj file with the frame's offset subtracted from each vertex. Throws
/// InputError on a vertex that is not three numbers, and on one that the file holds in single precision more
/// than 100 km from the file's own origin: it was rounded when the file was written.
std::string bytes_less_offset(const std::string& path, const MeshFrame& frame);

/// Whether a file's coordinates are not rounded to single precision: OBJ, text, and PLY of doubles.
bool holds_double_precision(const std::string& path);

/// Distance between neighbouring single-precision numbers at `value`.
double float_spacing(double value);

}  // namespace karst::cave
