// Where the strips of an extended profile have room beside each other.
#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "sdk/cave_drawing/free_runs.h"

namespace karst::cave_drawing {

/// By column of cells, what is free in it.
using ProfileCells = std::map<int, std::vector<Run>>;

/// Where a strip is drawn: column x of it at `column` + x, or - x - 1 if it goes to the left.
struct StripPlace {
  int column = 0;
  bool to_left = false;
  int of(int x) const { return to_left ? column - x - 1 : column + x; }
};

/// For a strip that branches off at `column`: to the right or to the left of it, or else moved aside by as
/// many `shift` columns as it takes. `apart` cells stay free around it, but for its first `hall` columns.
StripPlace place_for(const ProfileCells& drawn, const ProfileCells& strip, int column, int apart, int hall,
                     int shift, bool left_first);

/// a, b, ... z, aa, ab, ...
std::string letters(std::size_t i);

}  // namespace karst::cave_drawing
