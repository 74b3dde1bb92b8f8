// The frame of a mesh file's coordinates, and the way from there to metres with z up:
//
//   p = metres_per_unit * R * (p_file - offset),   R = 1, or with y up the turn (x, y, z) -> (x, -z, y)
#pragma once
#include <string>

#include "core_stack/common/geometry.h"
#include "core_stack/vehicle/mesh_keys.h"

namespace karst::cave {

struct MeshFrame {
  double metres_per_unit = 1;
  core::UpAxis up = core::UpAxis::z;
  core::Vec3 offset = core::Vec3::Zero();  // in the file's own coordinates
  bool states_its_own = false;             // a Collada file: the importer applies its unit and its axis
  bool given_as_options = false;           // --unit mm: there is no cave file that could hold the key
};

/// Vertices farther from the origin are refused: there floats still resolve 8 mm.
constexpr double kFarthestVertex_m = 1e5;

bool has_offset(const MeshFrame& frame);
/// Whether files in this frame are taken as they are.
bool is_plain(const MeshFrame& frame);

/// `from_offset`: a place in the file less the offset.
core::Vec3 to_metres(const MeshFrame& frame, const core::Vec3& from_offset);
/// The file's own coordinates of a place in metres.
core::Vec3 to_file(const MeshFrame& frame, const core::Vec3& place_m);

/// The name of the unit if it has one, "mm", or else how long it is, "0.5 m".
std::string unit_text(const MeshFrame& frame);

/// One line, equal for equal frames.
std::string to_text(const MeshFrame& frame);

/// The frame that the keys state. Throws InputError naming `source`: on an offset that is not three numbers,
/// and on a unit or an axis for a Collada file, which states its own.
MeshFrame mesh_frame(const std::string& source, const std::string& mesh_path, const core::MeshKeys& keys);

/// A mesh file and how it is to be read.
struct MeshFile {
  std::string path;
  MeshFrame frame;
};

}  // namespace karst::cave
