// A graph of passages cut into strips that can be laid out side by side: the longest way from the start, then
// the longest way off it, and so on.
#pragma once
#include <cstdint>
#include <vector>

#include "sdk/cave_drawing/passage_lines.h"

namespace karst::cave_drawing {

struct PassageStrip {
  std::vector<std::uint32_t> points;  // places; the first of all but the first strip are on an earlier one
  bool closes_loop = false;           // its last place is on an earlier strip
};

/// Every place is on a strip, and every line between places is part of one. The longest first.
std::vector<PassageStrip> passage_strips(const PassageLines& lines);

}  // namespace karst::cave_drawing
