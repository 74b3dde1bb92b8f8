// The axes of a paper's plots.
#pragma once
#include <string>
#include <vector>

namespace karst::campaign {

struct PlotTick {
  double at = 0;
  std::string text;
};

struct PlotAxis {
  double low = 0, high = 1;  // at the left or lower end, and at the other; may fall
  std::vector<PlotTick> ticks;
  std::string label;
};

/// An axis over these values, which are finite, with about so many ticks at multiples of 1, 2 or 5 times a
/// power of ten; it ends at such multiples.
PlotAxis number_axis(double least, double most, int ticks, const std::string& label);

/// An axis with a row for each name, the first at the top: row i is at i.
PlotAxis name_axis(const std::vector<std::string>& names);

}  // namespace karst::campaign
