// Plots for a paper, drawn as SVG. Lengths are in points (1/72 inch): what is drawn 252 wide is a column of
// IEEE's papers. The same input gives the same bytes.
#pragma once
#include <string>
#include <vector>

#include "sdk/campaign/paper/plot_axis.h"
#include "sdk/campaign/paper/plot_look.h"

namespace karst::campaign {

enum class MarkFill { filled, hollow };

class SvgPlot {
 public:
  /// Room for the axes' texts and for the legend's rows of names is made around `frame_height_pt`.
  SvgPlot(std::string title, PlotAxis x, PlotAxis y, double frame_height_pt, std::vector<std::string> legend);

  /// The area between two curves, lightly filled.
  void band(const std::vector<double>& x, const std::vector<double>& low, const std::vector<double>& high,
            const PlotLook& look);
  void curve(const std::vector<double>& x, const std::vector<double>& y, const PlotLook& look);
  /// A horizontal interval.
  void interval(double low, double high, double y, const PlotLook& look);
  void mark(double x, double y, const PlotLook& look, MarkFill fill);
  /// A dashed vertical line across the plot.
  void rule(double x);
  /// The whole file.
  std::string text() const;

 private:
  double at_x(double v) const;
  double at_y(double v) const;
  double whole_width_pt() const;
  void draw_legend();
  std::string axes() const;

  std::string title_;
  PlotAxis x_, y_;
  std::vector<std::string> legend_, x_label_;  // the label's lines
  double left_, top_, width_ = 0, height_;     // of the frame
  std::string body_, legend_text_;
};

}  // namespace karst::campaign
