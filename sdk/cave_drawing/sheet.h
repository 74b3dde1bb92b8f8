// A drawing on paper: how large it is drawn, and where on the page. Lengths on paper are in millimetres from
// the upper left corner.
#pragma once
#include <array>
#include <optional>
#include <string>

#include "core_stack/common/enum_names.h"
#include "sdk/cave_drawing/drawing.h"

namespace karst::cave_drawing {

enum class Paper { a4, a3 };
constexpr auto names_of(Paper) {
  using enum Paper;
  return std::to_array<core::Named<Paper>>({{a4, "a4"}, {a3, "a3"}});
}

struct SheetOptions {
  Paper paper = Paper::a4;
  std::optional<double> scale;  // 500: one to five hundred
  double declination_rad = 0;   // of the map's y axis, east of true north
};

/// The part of a page in which a drawing is, and what of the cave is there.
struct Frame {
  double left_mm = 0, top_mm = 0, width_mm = 0, height_mm = 0;
  double scale = 500;            // metres of the cave in a metre of paper
  Point corner = Point::Zero();  // at the lower left corner

  double mm_of(double m) const { return m * 1000 / scale; }
  Point at(const Point& p) const {
    return {left_mm + mm_of(p.x() - corner.x()), top_mm + height_mm - mm_of(p.y() - corner.y())};
  }
};

struct Sheet {
  double width_mm = 0, height_mm = 0;
  Frame frame;
  double title_top_mm = 0;  // of the title block, which is as wide as the frame and its labels
};

struct Extent {
  Point low = Point::Zero(), high = Point::Zero();
};

/// What the drawing covers. Throws core::InputError that names `file` if it is empty, or a point is not
/// finite.
Extent extent_of(const Drawing& drawing, const std::string& file);

/// The page, upright or on its side, on which the drawing is largest. The scale is 1, 1.5, 2, 2.5,
/// 3, 4, 5 or 7.5 times a power of ten. Throws core::InputError if the scale that is asked for does not fit.
Sheet fitted_sheet(const Extent& extent, const SheetOptions& options, const std::string& file);

/// The least of 1, 2, 5, 10, 20, ... m that is at least so many millimetres on paper.
double grid_step_m(double scale, double least_mm);

/// The greatest of 1, 2, 5, 10, 20, ... m that is at most so many millimetres on paper.
double bar_length_m(double scale, double most_mm);

}  // namespace karst::cave_drawing
