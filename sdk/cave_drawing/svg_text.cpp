#include "sdk/cave_drawing/svg_text.h"

#include <algorithm>
#include <array>

#include "core_stack/common/character_count.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/xml_text.h"

namespace karst::cave_drawing {
namespace {

constexpr double kCharacter = 0.56;  // of a text's size

std::string attribute(const char* name, std::string_view value) {
  return std::string(" ") + name + "=\"" + std::string(value) + "\"";
}

}  // namespace

std::string mm(double v) {
  std::string text = core::format_text("%.2f", v);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string stroke(std::string_view colour, double width_mm, std::string_view dashes) {
  return attribute("stroke", colour) + attribute("stroke-width", mm(width_mm)) +
         (dashes.empty() ? "" : attribute("stroke-dasharray", dashes));
}

std::string straight(const Point& a, const Point& b, const std::string& look) {
  return "<line" + attribute("x1", mm(a.x())) + attribute("y1", mm(a.y())) + attribute("x2", mm(b.x())) +
         attribute("y2", mm(b.y())) + look + "/>\n";
}

std::string box(double x, double y, double width, double height, const std::string& look) {
  return "<rect" + attribute("x", mm(x)) + attribute("y", mm(y)) + attribute("width", mm(width)) +
         attribute("height", mm(height)) + look + "/>\n";
}

std::string text(const Point& at, const std::string& plain, const TextLook& look) {
  constexpr std::array<const char*, 3> kAnchors{"start", "middle", "end"};
  return "<text" + attribute("x", mm(at.x())) + attribute("y", mm(at.y())) +
         attribute("font-size", mm(look.size_mm)) +
         attribute("text-anchor", kAnchors[static_cast<std::size_t>(look.anchor)]) +
         (look.bold ? attribute("font-weight", "bold") : "") +
         (look.halo ? attribute("stroke", "#ffffff") + attribute("stroke-width", "0.7") +
                          attribute("stroke-linejoin", "round") + attribute("paint-order", "stroke")
                    : "") +
         ">" + core::xml_text(plain) + "</text>\n";
}

double text_width_mm(const std::string& plain, double size_mm) {
  return kCharacter * size_mm * static_cast<double>(core::character_count(plain));
}

std::string cut_to(const std::string& plain, double size_mm, double width_mm) {
  if (text_width_mm(plain, size_mm) <= width_mm) return plain;
  const double one_mm = kCharacter * size_mm;
  const auto is_inside = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; };
  std::size_t bytes = 0;  // that are kept; the last character is the ellipsis
  for (int characters = 2; bytes < plain.size() && characters * one_mm <= width_mm; ++characters) {
    ++bytes;
    while (bytes < plain.size() && is_inside(plain[bytes])) ++bytes;
  }
  return plain.substr(0, bytes) + "\u2026";
}

}  // namespace karst::cave_drawing
