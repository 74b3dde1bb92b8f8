// Elements of an SVG whose unit is the millimetre: the same input gives the same bytes.
#pragma once
#include <string>
#include <string_view>

#include "sdk/cave_drawing/drawing.h"

namespace karst::cave_drawing {

/// A length or place, to the hundredth of a millimetre.
std::string mm(double v);

/// Attributes of a line: colour, width in mm, and dashes in mm ("" for none).
std::string stroke(std::string_view colour, double width_mm, std::string_view dashes = "");

std::string straight(const Point& a, const Point& b, const std::string& look);
std::string box(double x, double y, double width, double height, const std::string& look);

enum class Anchor { start, middle, end };
struct TextLook {
  double size_mm = 2.5;
  Anchor anchor = Anchor::start;
  bool bold = false;
  bool halo = false;  // white around the letters, so that lines do not cross them
};
/// `plain` is escaped; `at` is on the base line.
std::string text(const Point& at, const std::string& plain, const TextLook& look);

/// About how wide a text is: Helvetica's mean.
double text_width_mm(const std::string& plain, double size_mm);
/// Cut at a character, with an ellipsis, if it is wider.
std::string cut_to(const std::string& plain, double size_mm, double width_mm);

}  // namespace karst::cave_drawing
