// What is measured on drawings.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "core_stack/common/error.h"
#include "sdk/cave_drawing/drawing.h"
#include "sdk/cave_drawing/wall_trace.h"

namespace karst::test {

/// Square metres of spaces, those of holes taken off.
inline double area_m2(const cave_drawing::Drawing& drawing) {
  double sum = 0;
  for (const auto& rings : drawing.spaces)
    for (const cave_drawing::Line& ring : rings) sum += cave_drawing::signed_area(ring);
  return sum;
}

struct Span {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  double length() const { return high - low; }
};

/// Of all walls, to the right (0) or up (1).
inline Span span_of(const std::vector<cave_drawing::Line>& lines, int axis) {
  Span span;
  for (const cave_drawing::Line& line : lines)
    for (const cave_drawing::Point& p : line) {
      span.low = std::min(span.low, p[axis]);
      span.high = std::max(span.high, p[axis]);
    }
  return span;
}

inline long count_of(const cave_drawing::Drawing& drawing, cave_drawing::Mark::Kind kind) {
  return std::count_if(drawing.marks.begin(), drawing.marks.end(),
                       [&](const cave_drawing::Mark& m) { return m.kind == kind; });
}

template <class F>
std::string refusal_by(const F& call) {
  try {
    call();
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "";
}

}  // namespace karst::test
