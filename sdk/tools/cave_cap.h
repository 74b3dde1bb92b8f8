// `karst cave info --cap OUT.ply`: closes the holes of a cave's mesh.
#pragma once
#include <string>

#include "plugins/simulator/cave/mesh_frame.h"

namespace karst::tools {

struct CapArguments {
  std::string out;      // a .ply or .stl file that is not there yet
  double limit_m = 20;  // diameter of the widest hole that is closed
};

/// Writes the mesh with its holes closed and prints each loop of open edges: closed, or why not. Throws
/// core::InputError if the mesh cannot be read, the file cannot be written, or nothing was closed.
void write_capped(const cave::MeshFile& mesh, const CapArguments& args, bool json);

}  // namespace karst::tools
