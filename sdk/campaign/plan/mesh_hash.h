// What identifies the rock of a cave.
#pragma once
#include <string>

#include "plugins/simulator/cave/mesh_frame.h"

namespace karst::campaign {

/// SHA-256 of the mesh's bytes if they are taken as metres with z up; otherwise of that hash and the frame,
/// as the same file in another unit is another cave. Throws core::InputError if the file cannot be read.
std::string mesh_hash(const cave::MeshFile& mesh);

}  // namespace karst::campaign
