#include "sdk/cave_drawing/draw_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core_stack/common/format_text.h"
#include "sdk/cave_drawing/label_places.h"
#include "sdk/cave_drawing/smooth_line.h"
#include "sdk/cave_drawing/svg_text.h"

namespace karst::cave_drawing {
namespace {

constexpr double kWall_mm = 0.45, kThinWall_mm = 0.2, kUncertain_mm = 0.2, kHidden_mm = 0.25, kLeg_mm = 0.2,
                 kPath_mm = 0.13, kGrid_mm = 0.1;
constexpr double kBorder_mm = 0.3, kHatch_mm = 4;
constexpr const char *kKeepIn = "#00875a", *kKeepOut = "#c92a2a";
constexpr double kSmallScale = 2500;  // beyond, walls are thinner, and stations have no room
constexpr double kFine_mm = 0.05;     // lines are simplified by no more on paper
constexpr double kName_mm = 2.4, kNumber_mm = 2.2;

std::string path_of(const Line& line, const Frame& frame) {
  Line on_paper;
  for (const Point& p : line) on_paper.push_back(frame.at(p));
  const bool closed = line.size() > 2 && line.front() == line.back();
  on_paper = simplified(on_paper, kFine_mm);
  if (closed) on_paper.pop_back();
  std::string d;
  for (const Point& p : on_paper) d += (d.empty() ? "M" : "L") + mm(p.x()) + " " + mm(p.y());
  return d + (closed ? "Z" : "");
}

std::string lines_of(const char* name, const std::vector<Line>& lines, const Frame& frame,
                     const std::string& look) {
  if (lines.empty()) return "";
  std::string d;
  for (const Line& line : lines) d += path_of(line, frame);
  return std::string("<path class=\"") + name + "\" fill=\"none\"" + look + " d=\"" + d + "\"/>\n";
}

std::string number_text(double v) {
  const std::string digits = core::format_text("%.0f", std::abs(v));
  return v < 0 ? "\u2212" + digits : digits;
}

/// A symbol around a mark's place; "" for what has only a label.
std::string symbol_of(Mark::Kind kind, const Point& at) {
  const auto shape = [&](const char* name, const std::string& d, const char* fill) {
    return std::string("<path class=\"") + name + "\" fill=\"" + fill + "\"" + stroke("#000000", 0.25) +
           " d=\"M" + mm(at.x()) + " " + mm(at.y()) + d + "Z\"/>\n";
  };
  switch (kind) {
    case Mark::Kind::entrance:  // a triangle that points at it
      return shape("entrance", "l-1.5 -3.2h3", "#000000");
    case Mark::Kind::find:
      return shape("find", "m0 -1.4l1.4 1.4l-1.4 1.4l-1.4 -1.4", "#000000");
    case Mark::Kind::station:
      return shape("station", "m-0.4 -0.4h0.8v0.8h-0.8", "#000000");
    case Mark::Kind::height:
      return "<path class=\"height\" fill=\"none\"" + stroke("#000000", 0.2) + " d=\"M" + mm(at.x() - 0.6) +
             " " + mm(at.y()) + "h1.2M" + mm(at.x()) + " " + mm(at.y() - 0.6) + "v1.2\"/>\n";
    case Mark::Kind::unknown_end:
    case Mark::Kind::joint:
      return "";
  }
  return "";
}

std::string question(const Point& at) {
  return text({at.x(), at.y() + 1.5}, "?", {4.2, Anchor::middle, true, true});
}
std::string joint_circle(const Point& at, const std::string& name) {
  return "<circle class=\"joint\" cx=\"" + mm(at.x()) + "\" cy=\"" + mm(at.y()) +
         "\" r=\"1.7\" fill=\"#ffffff\"" + stroke("#000000", 0.15) + "/>\n" +
         text({at.x(), at.y() + 0.8}, name, {kNumber_mm, Anchor::middle});
}

/// Entrances, finds, ends that lead on and joints have their place; numbers and names get what room is left.
std::string marks_of(const Drawing& drawing, const Frame& frame) {
  using enum Mark::Kind;
  std::string symbols, labels;
  LabelPlaces places(frame);
  for (const Mark& m : drawing.marks) {
    const Point at = frame.at(m.at);
    if (m.kind == unknown_end) labels += question(at), places.keep(at, 3, 4);
    if (m.kind == joint) labels += joint_circle(at, m.text), places.keep(at, 3.6, 3.6);
    if (m.kind == entrance) places.keep(at - Point(0, 1.6), 3, 3.4);
    if (m.kind == find) places.keep(at, 2.8, 2.8);
  }
  for (const Mark::Kind kind : {entrance, find, height, station})
    for (const Mark& m : drawing.marks) {
      if (m.kind != kind || (kind == station && frame.scale > kSmallScale)) continue;
      const Point at = frame.at(m.at);
      const bool must = kind == entrance || kind == find;
      const double size = kind == height || kind == station ? kNumber_mm : kName_mm;
      // Numbers are not as close as they could be: a passage has many of them.
      const double width = text_width_mm(m.text, size) + (kind == height ? 4 : 0);
      const std::optional<Point> place =
          must ? places.beside_anyhow(at, width, size) : places.beside(at, width, size);
      if (place) labels += text(*place, m.text, {size, Anchor::start, kind == entrance, true});
      if (place || kind == station) symbols += symbol_of(kind, at);
    }
  return symbols + labels;
}

/// The grid's lines between two places on an axis.
std::vector<double> grid_values(double low, double length_m, double step_m) {
  std::vector<double> values;
  for (double i = std::ceil(low / step_m - 1e-9); i * step_m <= low + length_m + 1e-9; ++i)
    values.push_back(i * step_m + 0.0);
  return values;
}

double across_m(const Frame& frame) { return frame.width_mm * frame.scale / 1000; }
double upwards_m(const Frame& frame) { return frame.height_mm * frame.scale / 1000; }

std::string grid_lines(const Frame& frame, double step_m) {
  std::string out = "<g class=\"grid\"" + stroke("#999999", kGrid_mm) + ">\n";
  for (const double v : grid_values(frame.corner.x(), across_m(frame), step_m)) {
    const double x = frame.at({v, 0}).x();
    out += straight({x, frame.top_mm}, {x, frame.top_mm + frame.height_mm}, "");
  }
  for (const double v : grid_values(frame.corner.y(), upwards_m(frame), step_m)) {
    const double y = frame.at({0, v}).y();
    out += straight({frame.left_mm, y}, {frame.left_mm + frame.width_mm, y}, "");
  }
  return out + "</g>\n";
}

/// Lines across the inside of a closed outline, in mm from the lower left to the upper right, within the
/// frame.
std::vector<std::array<Point, 2>> hatching(const Line& outline, const Frame& frame) {
  // Lines of y - x = v; on each, the outline's edges are crossed where the inside begins or ends.
  const Point corner(frame.left_mm, frame.top_mm);
  std::vector<std::array<Point, 2>> lines;
  for (double v = corner.y() - corner.x() - frame.width_mm; v < corner.y() - corner.x() + frame.height_mm;
       v += kHatch_mm) {
    std::vector<Point> crossings;
    for (std::size_t i = 0; i + 1 < outline.size(); ++i) {
      const Point a = frame.at(outline[i]), b = frame.at(outline[i + 1]);
      const double from = a.y() - a.x() - v, to = b.y() - b.x() - v;
      if ((from < 0) != (to < 0)) crossings.push_back(a + (b - a) * (from / (from - to)));
    }
    std::sort(crossings.begin(), crossings.end(),
              [](const Point& a, const Point& b) { return a.x() < b.x(); });
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
      lines.push_back({crossings[i], crossings[i + 1]});
  }
  return lines;
}

std::string hatched(const std::vector<Line>& outlines, const Frame& frame) {
  std::string d;
  for (const Line& outline : outlines)
    for (const auto& [a, b] : hatching(outline, frame))
      d += "M" + mm(a.x()) + " " + mm(a.y()) + "L" + mm(b.x()) + " " + mm(b.y());
  if (d.empty()) return "";
  return "<path class=\"keep-out-hatching\" fill=\"none\"" + stroke(kKeepOut, kGrid_mm) + " d=\"" + d +
         "\"/>\n";
}

/// A region may be much larger than the cave: its border is cut at the frame.
std::string borders_of(const Drawing& drawing, const Frame& frame) {
  if (drawing.keep_in.empty() && drawing.keep_out.empty()) return "";
  const std::string name = std::string("frame-") + core::name_of(drawing.view);  // a page may have several
  return "<clipPath id=\"" + name + "\">" +
         box(frame.left_mm, frame.top_mm, frame.width_mm, frame.height_mm, "") +
         "</clipPath>\n<g clip-path=\"url(#" + name + ")\">\n" + hatched(drawing.keep_out, frame) +
         lines_of("keep-out", drawing.keep_out, frame, stroke(kKeepOut, kBorder_mm)) +
         lines_of("keep-in", drawing.keep_in, frame, stroke(kKeepIn, kBorder_mm, "3 0.8 0.6 0.8")) + "</g>\n";
}

}  // namespace

std::string grid_numbers(const Frame& frame, double step_m) {
  std::string out;
  const double low_mm = frame.top_mm + frame.height_mm;
  for (const double v : grid_values(frame.corner.x(), across_m(frame), step_m)) {
    const double x = frame.at({v, 0}).x(), half = 0.5 * text_width_mm(number_text(v), kNumber_mm);
    if (x - half >= frame.left_mm && x + half <= frame.left_mm + frame.width_mm)
      out += text({x, low_mm + kNumber_mm + 1}, number_text(v), {kNumber_mm, Anchor::middle});
  }
  for (const double v : grid_values(frame.corner.y(), upwards_m(frame), step_m)) {
    const double y = frame.at({0, v}).y() + 0.35 * kNumber_mm;
    if (y - kNumber_mm >= frame.top_mm && y <= low_mm)
      out += text({frame.left_mm - 1, y}, number_text(v), {kNumber_mm, Anchor::end});
  }
  return out;
}

std::string inside_frame(const Drawing& drawing, const Frame& frame, double step_m) {
  std::string out;
  for (const std::vector<Line>& rings : drawing.spaces) {
    std::string d;
    for (const Line& ring : rings) d += path_of(ring, frame);
    out += "<path class=\"space\" fill=\"#ececec\" fill-rule=\"evenodd\" d=\"" + d + "\"/>\n";
  }
  out += grid_lines(frame, step_m);
  const std::string round = " stroke-linejoin=\"round\" stroke-linecap=\"round\"";
  out += lines_of("hidden", drawing.hidden_walls, frame, stroke("#707070", kHidden_mm, "1.2 0.8") + round);
  out += lines_of("splays", drawing.splays, frame, stroke("#909090", kPath_mm));
  out += lines_of("path", drawing.paths, frame, stroke("#404040", kPath_mm) + round);
  out += borders_of(drawing, frame);
  out += lines_of("links", drawing.links, frame, stroke("#404040", kLeg_mm, "0.6 0.9"));
  out += lines_of("legs", drawing.centreline, frame, stroke("#303030", kLeg_mm) + round);
  out += lines_of("uncertain", drawing.uncertain_walls, frame, stroke("#000000", kUncertain_mm, "2 1.2"));
  out += lines_of("walls", drawing.walls, frame,
                  stroke("#000000", frame.scale > kSmallScale ? kThinWall_mm : kWall_mm) + round);
  return out + marks_of(drawing, frame) +
         box(frame.left_mm, frame.top_mm, frame.width_mm, frame.height_mm,
             " class=\"frame\" fill=\"none\"" + stroke("#000000", 0.25));
}

std::string scale_bar(const Point& left_top, double scale, double most_mm) {
  constexpr int kPieces = 4;
  constexpr double kHigh_mm = 1.6;
  const double bar_m = bar_length_m(scale, most_mm), bar_mm = bar_m * 1000 / scale;
  std::string out = "<g class=\"bar\">\n";
  const double y = left_top.y() + 3.2;
  out +=
      box(left_top.x(), y, bar_mm, kHigh_mm, " class=\"length\" fill=\"#ffffff\"" + stroke("#000000", 0.2));
  for (int i = 0; i < kPieces; i += 2)
    out += box(left_top.x() + i * bar_mm / kPieces, y, bar_mm / kPieces, kHigh_mm, " fill=\"#000000\"");
  out += text({left_top.x(), y - 0.8}, "0", {kNumber_mm, Anchor::middle});
  out +=
      text({left_top.x() + bar_mm, y - 0.8}, core::format_text("%g m", bar_m), {kNumber_mm, Anchor::middle});
  return out + "</g>\n";
}

std::string north_arrow(const Point& middle, double turned_rad) {
  constexpr double kHalf_mm = 8;
  const Point up(std::sin(turned_rad), -std::cos(turned_rad)), aside(-up.y(), up.x());
  const Point tip = middle + kHalf_mm * up, foot = middle - 0.6 * kHalf_mm * up;
  const auto corner = [](const Point& p) { return mm(p.x()) + " " + mm(p.y()); };
  const Point notch = middle - 0.25 * kHalf_mm * up;
  const Point one = foot + 2.2 * aside, other = foot - 2.2 * aside;
  return "<g class=\"north\">\n<path fill=\"#000000\" d=\"M" + corner(tip) + "L" + corner(one) + "L" +
         corner(notch) + "Z\"/>\n<path fill=\"#ffffff\"" + stroke("#000000", 0.2) + " d=\"M" + corner(tip) +
         "L" + corner(other) + "L" + corner(notch) + "Z\"/>\n" +
         text(middle + 1.3 * kHalf_mm * up + Point(0, 1.2), "N", {3.2, Anchor::middle, true}) + "</g>\n";
}

}  // namespace karst::cave_drawing
