#include "sdk/preflight/plan_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "core_stack/common/format_text.h"

namespace karst::preflight {
namespace {

constexpr int kMostRows = 400;  // of the picture
constexpr double kWidth_mm = 180, kHeight_mm = 110;

/// The greatest of 1, 2, 5, 10, 20, ... m that is at most a third of the width.
double bar_m(double width_m) {
  double bar = 1;
  for (double decade = 1; decade <= width_m / 3; decade *= 10)
    for (const double step : {1.0, 2.0, 5.0})
      if (decade * step <= width_m / 3) bar = decade * step;
  return bar;
}

int divided_down(int v, int by) { return static_cast<int>(std::floor(static_cast<double>(v) / by)); }

}  // namespace

PlanView plan_view(const evaluation::CellSet& cells, double resolution_m, const core::Vec3& start) {
  int low = std::numeric_limits<int>::max(), high = std::numeric_limits<int>::min();
  cells.for_each([&](const core::CellKey& k) {
    low = std::min(low, k.y);
    high = std::max(high, k.y);
  });
  PlanView plan;
  plan.start = start;
  plan.edge_m = resolution_m;
  if (high < low) return plan;
  const int joined = (high - low) / kMostRows + 1;
  plan.edge_m = resolution_m * joined;
  std::set<std::pair<int, int>> columns;  // y, x
  cells.for_each(
      [&](const core::CellKey& k) { columns.emplace(divided_down(k.y, joined), divided_down(k.x, joined)); });
  for (const auto& [y, x] : columns) {
    if (!plan.runs.empty() && plan.runs.back().y == y && plan.runs.back().x + plan.runs.back().length == x)
      ++plan.runs.back().length;
    else
      plan.runs.push_back({x, y, 1});
  }
  return plan;
}

std::string to_svg(const PlanView& plan) {
  if (plan.runs.empty()) return "";
  int west = std::numeric_limits<int>::max(), east = std::numeric_limits<int>::min();
  for (const ColumnRun& r : plan.runs) {
    west = std::min(west, r.x);
    east = std::max(east, r.x + r.length);
  }
  const int south = plan.runs.front().y, north = plan.runs.back().y + 1;
  const double width_m = (east - west) * plan.edge_m, cave_m = (north - south) * plan.edge_m;
  const double text_m = std::max(width_m / 45, cave_m / 28), height_m = cave_m + 2.5 * text_m;
  const double mm = std::min(kWidth_mm / width_m, kHeight_mm / height_m);  // per metre
  std::string out = core::format_text(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plan\" role=\"img\" aria-label=\"The cave from "
      "above\" width=\"%.1fmm\" height=\"%.1fmm\" viewBox=\"0 0 %.2f %.2f\">\n<path class=\"cave\" d=\"",
      width_m * mm, height_m * mm, width_m, height_m);
  for (const ColumnRun& r : plan.runs)
    out += core::format_text("M%.6g %.6gh%.6gv%.6gh%.6gz", (r.x - west) * plan.edge_m,
                             (north - 1 - r.y) * plan.edge_m, r.length * plan.edge_m, plan.edge_m,
                             -r.length * plan.edge_m);
  const double x = plan.start.x() - west * plan.edge_m, y = north * plan.edge_m - plan.start.y();
  out += core::format_text("\"/>\n<circle class=\"start\" cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\"/>\n", x, y,
                           0.45 * text_m);
  const double bar = std::min(bar_m(width_m), width_m), bar_y = cave_m + 0.8 * text_m;
  return out + core::format_text(
                   "<path class=\"bar\" stroke-width=\"%.2f\" d=\"M0 %.2fh%.2f\"/>\n"
                   "<text x=\"0\" y=\"%.2f\" font-size=\"%.2f\">%g m</text>\n</svg>\n",
                   0.15 * text_m, bar_y, bar, bar_y + 1.3 * text_m, text_m, bar);
}

}  // namespace karst::preflight
