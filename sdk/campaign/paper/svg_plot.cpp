#include "sdk/campaign/paper/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "core_stack/common/character_count.h"
#include "core_stack/common/xml_text.h"
#include "sdk/campaign/verdict/figure_words.h"

namespace karst::campaign {
namespace {

constexpr double kColumn_pt = 252, kMinFrame_pt = 130, kEdge_pt = 6;
constexpr double kText_pt = 8, kTickText_pt = 7, kCharacter = 0.56;  // of a text's size: Helvetica's mean
constexpr double kLegendRow_pt = 11, kSample_pt = 20, kLabelRow_pt = 10;

using core::xml_text;

std::string pt(double v) { return fixed_text(v, 2); }

double text_width_pt(const std::string& text, double size_pt) {
  return kCharacter * size_pt * static_cast<double>(core::character_count(text));
}

std::string attribute(const char* name, std::string_view value) {
  return std::string(" ") + name + "=\"" + std::string(value) + "\"";
}

std::string line_between(double x1, double y1, double x2, double y2, const std::string& more = "") {
  return "<line" + attribute("x1", pt(x1)) + attribute("y1", pt(y1)) + attribute("x2", pt(x2)) +
         attribute("y2", pt(y2)) + more + "/>\n";
}

std::string text_at(double x, double y, double size_pt, const char* anchor, const std::string& plain,
                    const std::string& more = "") {
  return "<text" + attribute("x", pt(x)) + attribute("y", pt(y)) + attribute("font-size", pt(size_pt)) +
         attribute("text-anchor", anchor) + more + ">" + xml_text(plain) + "</text>\n";
}

std::string stroke_of(const PlotLook& look) {
  return attribute("stroke", look.colour) + attribute("stroke-width", "1.2") +
         (!look.dashes.empty() ? attribute("stroke-dasharray", look.dashes) : "");
}

std::string mark_path(double x, double y, const PlotLook& look, MarkFill fill) {
  return "<path" + attribute("d", look.mark) +
         attribute("transform", "translate(" + pt(x) + " " + pt(y) + ")") +
         attribute("fill", fill == MarkFill::filled ? look.colour : "#ffffff") +
         attribute("stroke", look.colour) + attribute("stroke-width", "0.8") + "/>\n";
}

/// Adds the text in lines between words, each as wide as this or of one word.
void add_lines(const std::string& text, double width_pt, std::vector<std::string>& lines) {
  std::istringstream words(text);
  std::string line;
  for (std::string word; words >> word;) {
    if (!line.empty() && text_width_pt(line + " " + word, kText_pt) > width_pt)
      lines.push_back(std::exchange(line, ""));
    line += (line.empty() ? "" : " ") + word;
  }
  if (!line.empty()) lines.push_back(line);
}

/// An axis's label; its unit, in brackets, begins a line of its own where not all fits in one.
std::vector<std::string> label_lines(const std::string& label, double width_pt) {
  std::vector<std::string> lines;
  const std::size_t unit = text_width_pt(label, kText_pt) > width_pt ? label.rfind(" (") : std::string::npos;
  add_lines(label.substr(0, unit), width_pt, lines);
  if (unit != std::string::npos) add_lines(label.substr(unit), width_pt, lines);
  return lines;
}

double entry_width_pt(const std::string& name) { return kSample_pt + 12 + text_width_pt(name, kText_pt); }

}  // namespace

SvgPlot::SvgPlot(std::string title, PlotAxis x, PlotAxis y, double frame_height_pt,
                 std::vector<std::string> legend)
    : title_(std::move(title)),
      x_(std::move(x)),
      y_(std::move(y)),
      legend_(std::move(legend)),
      left_(kEdge_pt + (y_.label.empty() ? 0 : 12)),
      top_(kEdge_pt),
      height_(frame_height_pt) {
  double names_pt = 0;
  for (const PlotTick& t : y_.ticks) names_pt = std::max(names_pt, text_width_pt(t.text, kTickText_pt));
  left_ += names_pt + 3;
  width_ = std::max(kMinFrame_pt, kColumn_pt - left_ - 2 * kEdge_pt);
  for (const std::string& name : legend_)
    width_ = std::max(width_, entry_width_pt(name) - left_);  // else it would be cut off
  x_label_ = label_lines(x_.label, whole_width_pt() - 2 * kEdge_pt);
  for (const std::string& line : x_label_)  // a single long word
    width_ = std::max(width_, text_width_pt(line, kText_pt) - left_);
  draw_legend();
}

double SvgPlot::whole_width_pt() const { return left_ + width_ + 2 * kEdge_pt; }
double SvgPlot::at_x(double v) const { return left_ + (v - x_.low) / (x_.high - x_.low) * width_; }
double SvgPlot::at_y(double v) const { return top_ + (y_.high - v) / (y_.high - y_.low) * height_; }

/// Rows above the frame, which moves down for them.
void SvgPlot::draw_legend() {
  double x = kEdge_pt;
  for (std::size_t i = 0; i < legend_.size(); ++i) {
    const double width = entry_width_pt(legend_[i]);
    if (x > kEdge_pt && x + width > left_ + width_ + 2 * kEdge_pt) x = kEdge_pt, top_ += kLegendRow_pt;
    const PlotLook look = plot_look(i);
    const double y = top_ + kLegendRow_pt / 2;
    legend_text_ += line_between(x, y, x + kSample_pt, y, stroke_of(look)) +
                    mark_path(x + kSample_pt / 2, y, look, MarkFill::filled) +
                    text_at(x + kSample_pt + 3, y + 2.8, kText_pt, "start", legend_[i]);
    x += width;
  }
  if (!legend_.empty()) top_ += kLegendRow_pt + 3;
}

void SvgPlot::band(const std::vector<double>& x, const std::vector<double>& low,
                   const std::vector<double>& high, const PlotLook& look) {
  std::string there, back;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(low[i]) || !std::isfinite(high[i])) continue;
    there += pt(at_x(x[i])) + "," + pt(at_y(high[i])) + " ";
    back = pt(at_x(x[i])) + "," + pt(at_y(low[i])) + " " + back;
  }
  if (there.empty()) return;
  body_ += "<polygon" + attribute("points", there + back) + attribute("fill", look.colour) +
           attribute("fill-opacity", "0.15") + "/>\n";
}

void SvgPlot::curve(const std::vector<double>& x, const std::vector<double>& y, const PlotLook& look) {
  std::string points;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (std::isfinite(y[i])) points += (points.empty() ? "" : " ") + pt(at_x(x[i])) + "," + pt(at_y(y[i]));
  body_ += "<polyline" + attribute("points", points) + attribute("fill", "none") + stroke_of(look) +
           attribute("stroke-linejoin", "round") + "/>\n";
}

void SvgPlot::interval(double low, double high, double y, const PlotLook& look) {
  if (std::isfinite(low) && std::isfinite(high))
    body_ += line_between(at_x(low), at_y(y), at_x(high), at_y(y),
                          attribute("class", "interval") + stroke_of({look.colour, "", look.mark}));
}

void SvgPlot::mark(double x, double y, const PlotLook& look, MarkFill fill) {
  if (std::isfinite(x) && std::isfinite(y)) body_ += mark_path(at_x(x), at_y(y), look, fill);
}

void SvgPlot::rule(double x) {
  body_ += line_between(at_x(x), top_, at_x(x), top_ + height_,
                        attribute("stroke", "#555555") + attribute("stroke-width", "0.6") +
                            attribute("stroke-dasharray", "3 2"));
}

std::string SvgPlot::axes() const {
  const double right = left_ + width_, bottom = top_ + height_;
  std::string out;
  for (const PlotTick& t : x_.ticks) out += text_at(at_x(t.at), bottom + 9, kTickText_pt, "middle", t.text);
  for (const PlotTick& t : y_.ticks) out += text_at(left_ - 3, at_y(t.at) + 2.5, kTickText_pt, "end", t.text);
  double half = 0;  // of the widest line: below the middle of the frame, but not over the edges
  for (const std::string& line : x_label_) half = std::max(half, text_width_pt(line, kText_pt) / 2);
  const double middle =
      std::max(kEdge_pt + half, std::min((left_ + right) / 2, whole_width_pt() - kEdge_pt - half));
  for (std::size_t i = 0; i < x_label_.size(); ++i)
    out +=
        text_at(middle, bottom + 20 + kLabelRow_pt * static_cast<double>(i), kText_pt, "middle", x_label_[i]);
  const double y = (top_ + bottom) / 2, x = kEdge_pt + kText_pt / 2;
  if (!y_.label.empty())
    out += text_at(x, y, kText_pt, "middle", y_.label,
                   attribute("transform", "rotate(-90 " + pt(x) + " " + pt(y) + ")"));
  return out;
}

std::string SvgPlot::text() const {
  const double right = left_ + width_, bottom = top_ + height_;
  const std::string wide = pt(whole_width_pt()),
                    high = pt(bottom + (x_label_.empty()
                                            ? 13
                                            : 15 + kLabelRow_pt * static_cast<double>(x_label_.size())));
  std::string grid;
  for (const PlotTick& t : x_.ticks) grid += line_between(at_x(t.at), top_, at_x(t.at), bottom);
  for (const PlotTick& t : y_.ticks) grid += line_between(left_, at_y(t.at), right, at_y(t.at));
  return "<svg xmlns=\"http://www.w3.org/2000/svg\"" + attribute("width", wide + "pt") +
         attribute("height", high + "pt") + attribute("viewBox", "0 0 " + wide + " " + high) +
         attribute("font-family", "Helvetica, Arial, sans-serif") + ">\n<title>" + xml_text(title_) +
         "</title>\n<g stroke=\"#d9d9d9\" stroke-width=\"0.5\">\n" + grid + "</g>\n" + body_ + "<rect" +
         attribute("class", "frame") + attribute("x", pt(left_)) + attribute("y", pt(top_)) +
         attribute("width", pt(width_)) + attribute("height", pt(height_)) +
         " fill=\"none\" stroke=\"#000000\" stroke-width=\"0.6\"/>\n" + axes() + legend_text_ + "</svg>\n";
}

}  // namespace karst::campaign
