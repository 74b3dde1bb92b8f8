#include "sdk/cave_drawing/sheet.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"

namespace karst::cave_drawing {
namespace {

constexpr double kMargin_mm = 10;       // printers leave it white
constexpr double kTitle_mm = 34;        // the title block
constexpr double kLabels_mm = 9;        // the grid's numbers, to the left
constexpr double kLowLabels_mm = 5;     // and below
constexpr double kAround_mm = 6;        // around the cave, for marks and names
constexpr double kLargestScale = 20;    // nothing is drawn larger
constexpr double kSmallestScale = 1e6;  // a metre for a thousand kilometres

Sheet page_of(Paper paper, bool upright) {
  const double shorter = paper == Paper::a4 ? 210 : 297, longer = paper == Paper::a4 ? 297 : 420;
  Sheet sheet;
  sheet.width_mm = upright ? shorter : longer;
  sheet.height_mm = upright ? longer : shorter;
  sheet.frame.left_mm = kMargin_mm + kLabels_mm;
  sheet.frame.top_mm = kMargin_mm;
  sheet.frame.width_mm = sheet.width_mm - sheet.frame.left_mm - kMargin_mm;
  sheet.title_top_mm = sheet.height_mm - kMargin_mm - kTitle_mm;
  sheet.frame.height_mm = sheet.title_top_mm - kLowLabels_mm - sheet.frame.top_mm;
  return sheet;
}

/// The scale at which the extent just fits the frame.
double least_scale(const Extent& extent, const Frame& frame) {
  const Point size = extent.high - extent.low;
  return 1000 * std::max(size.x() / (frame.width_mm - 2 * kAround_mm),
                         size.y() / (frame.height_mm - 2 * kAround_mm));
}

double round_scale(double least) {
  for (double decade = 10; decade <= kSmallestScale; decade *= 10)
    for (const double step : {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 7.5})
      if (decade * step >= std::max(least, kLargestScale) * (1 - 1e-9)) return decade * step;
  return least;
}

void put_in_the_middle(const Extent& extent, Frame& frame) {
  const Point size(frame.width_mm, frame.height_mm);
  frame.corner = 0.5 * (extent.low + extent.high) - 0.5 * frame.scale / 1000 * size;
}

class Covered {
 public:
  explicit Covered(std::string file) : file_(std::move(file)) {}
  void add(const Point& p) {
    if (!p.allFinite()) throw core::InputError(file_, "", "a position is not a number");
    low_ = low_.cwiseMin(p);
    high_ = high_.cwiseMax(p);
  }
  void add(const std::vector<Line>& lines) {
    for (const Line& line : lines)
      for (const Point& p : line) add(p);
  }
  Extent extent() const {
    if (!low_.allFinite()) throw core::InputError(file_, "", "there is nothing to draw");
    return {low_, high_};
  }

 private:
  std::string file_;
  Point low_ = Point::Constant(std::numeric_limits<double>::infinity()), high_ = -low_;
};

}  // namespace

Extent extent_of(const Drawing& drawing, const std::string& file) {
  Covered covered(file);
  for (const auto& rings : drawing.spaces) covered.add(rings);
  for (const auto* lines : {&drawing.walls, &drawing.uncertain_walls, &drawing.hidden_walls,
                            &drawing.centreline, &drawing.paths, &drawing.splays, &drawing.links})
    covered.add(*lines);
  for (const Mark& m : drawing.marks) covered.add(m.at);
  return covered.extent();
}

Sheet fitted_sheet(const Extent& extent, const SheetOptions& options, const std::string& file) {
  Sheet upright = page_of(options.paper, true), across = page_of(options.paper, false);
  const double least_upright = least_scale(extent, upright.frame);
  const double least_across = least_scale(extent, across.frame);
  Sheet sheet = least_upright < least_across ? upright : across;
  const double least = std::min(least_upright, least_across);
  sheet.frame.scale = round_scale(least);
  if (options.scale) {
    if (!std::isfinite(*options.scale) || *options.scale < 1)
      throw core::InputError(file, "", "the scale is no number of 1 or more");
    if (*options.scale < least * (1 - 1e-9))
      throw core::InputError(file, "",
                             core::format_text("does not fit on %s at 1:%g; it does at 1:%g",
                                               std::string(core::name_of(options.paper)).c_str(),
                                               *options.scale, sheet.frame.scale));
    sheet.frame.scale = *options.scale;
  }
  put_in_the_middle(extent, sheet.frame);
  return sheet;
}

double grid_step_m(double scale, double least_mm) {
  for (double decade = 1;; decade *= 10)
    for (const double step : {1.0, 2.0, 5.0})
      if (decade * step * 1000 >= least_mm * scale) return decade * step;
}

double bar_length_m(double scale, double most_mm) {
  double bar = 1;
  for (double decade = 1; decade * 1000 <= most_mm * scale; decade *= 10)
    for (const double step : {1.0, 2.0, 5.0})
      if (decade * step * 1000 <= most_mm * scale) bar = decade * step;
  return bar;
}

}  // namespace karst::cave_drawing
