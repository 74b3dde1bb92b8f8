// The files of a cave that a command makes.
#pragma once
#include <string>

namespace karst::tools {

struct CaveFiles {
  std::string mesh, info;  // paths
  std::string mesh_name;   // as the .info file names the mesh
};

/// OUT.info, and the mesh beside it; makes the folder that they are to stand in. Throws core::InputError if
/// one of them is there already, unless `force`, or if the folder cannot be made.
CaveFiles new_cave_files(const std::string& out, const std::string& mesh_format, bool force);

/// A line of a cave's .info file that is a comment, whatever the text holds.
std::string comment_line(const std::string& text);

}  // namespace karst::tools
