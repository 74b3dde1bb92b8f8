// The lines of INFO text, each with where it came from, within bounds.
//
// Boost's own reader opens whatever `#include` names, looks for it in the working directory, calls itself at
// every level and reads without end. So it is given lines without directives, and no more of them than any
// file of karst's needs.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace karst::core {

struct InfoLine {
  std::string text, file;
  std::size_t number = 0;  // in `file`, from 1
  std::string place() const { return "line " + std::to_string(number); }
};

constexpr std::size_t kMaxInfoBytes = 16u << 20;  // a file with all that it includes
constexpr std::size_t kMaxInfoLineBytes = 64u << 10;
constexpr std::size_t kMaxInfoWords = 400'000;  // keys, values and braces

/// Whether `#include "part.info"` is followed, relative to the file it stands in. Only a mission file of the
/// user's own may have it; what a run, a campaign or a policy left is read as it is.
enum class Includes { refuse, follow };

/// Throws InputError naming the file and line of what cannot be read or goes beyond the bounds.
std::vector<InfoLine> info_lines(const std::string& file, Includes includes);

/// The lines of `text`, which came from `source`: no file is opened. Throws InputError.
std::vector<InfoLine> info_lines_of(std::string_view text, const std::string& source);

/// Throws InputError at the line where there are too many words, where one is too long, or where blocks stand
/// deeper in each other than any file needs: reading and destroying a tree recurse.
void check_bounds(const std::vector<InfoLine>& lines);

/// A path that a file names, from that file's folder and not from the one the command is run in.
std::string beside(const std::string& file, const std::string& path);

}  // namespace karst::core
