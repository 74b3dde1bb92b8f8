// The lines of an INFO file with those it includes in their places: `#include "part.info"` names a file
// relative to the file that includes it. (Boost's own reader looks in the working directory.)
#pragma once
#include <string>
#include <vector>

namespace karst::core {

struct InfoLine {
  std::string text, file;
  std::size_t number = 0;  // in `file`, from 1
  std::string place() const { return "line " + std::to_string(number); }
};

/// Throws InputError naming the file and line of what cannot be read.
std::vector<InfoLine> info_lines(const std::string& file);

/// Throws InputError at the line where blocks stand deeper in each other than any file needs: reading and
/// destroying a tree recurse.
void check_depth(const std::vector<InfoLine>& lines);

/// A path that a file names, from that file's folder and not from the one the command is run in.
std::string beside(const std::string& file, const std::string& path);

}  // namespace karst::core
