// How contestants are told apart in a paper's plots.
#pragma once
#include <cstddef>
#include <string_view>

namespace karst::campaign {

/// Five colours differ in lightness, so that they differ in grey and for readers who do not see all colours.
/// Six dashes and five marks tell thirty contestants apart without any colour.
struct PlotLook {
  std::string_view colour;  // "#004f94"
  std::string_view dashes;  // lengths of strokes and gaps in points; "" for a solid line
  std::string_view mark;    // SVG path around the origin, with a radius of about two points
};
PlotLook plot_look(std::size_t contestant);

}  // namespace karst::campaign
