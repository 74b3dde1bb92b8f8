#include "sdk/cave_drawing/svg_sheet.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "core_stack/common/format_text.h"
#include "core_stack/common/xml_text.h"
#include "sdk/cave_drawing/draw_frame.h"
#include "sdk/cave_drawing/svg_text.h"

namespace karst::cave_drawing {
namespace {

constexpr double kGridLeast_mm = 15;  // between two lines of the grid
constexpr double kPad_mm = 3;         // inside the title block

std::string degrees_text(double bearing_rad) {
  const double whole = std::round(bearing_rad * 180 / std::numbers::pi);
  return core::format_text("%03.0f\u00B0", std::fmod(std::fmod(whole, 360) + 360, 360));
}

std::string view_title(const Drawing& drawing) {
  switch (drawing.view) {
    case View::plan:
      return "Plan";
    case View::extended_profile:
      return "Extended profile";
    case View::projected_profile:
      return "Projected profile, bearing " + degrees_text(drawing.bearing_rad);
  }
  return "";
}

std::vector<std::string> fact_lines(const CaveFacts& facts) {
  std::vector<std::string> lines;
  if (facts.length_m) lines.push_back(core::format_text("length %.0f m", *facts.length_m));
  if (facts.depth_m) lines.push_back(core::format_text("depth %.0f m", *facts.depth_m));
  if (facts.floor_to_roof_m)
    lines.push_back(core::format_text("floor to roof %.0f m", *facts.floor_to_roof_m));
  if (facts.volume_m3) lines.push_back(core::format_text("volume %.0f m\u00B3", *facts.volume_m3));
  if (!facts.date.empty()) lines.push_back(facts.date);
  return lines;
}

std::string legend_text(const Drawing& drawing, const CaveFacts& facts, const Frame& frame, double step_m) {
  std::string legend = core::format_text("grid %g m", step_m);
  if (drawing.view == View::plan) legend += ", grid north up";
  bool heights = drawing.view != View::plan, from_entrance = false, leads_on = false, joints = false;
  for (const Mark& m : drawing.marks) {
    heights = heights || m.kind == Mark::Kind::height;
    from_entrance = from_entrance || m.kind == Mark::Kind::entrance;
    leads_on = leads_on || m.kind == Mark::Kind::unknown_end;
    joints = joints || m.kind == Mark::Kind::joint;
  }
  if (heights) legend += from_entrance ? ", heights in metres from the entrance" : ", heights in metres";
  if (!drawing.hidden_walls.empty()) legend += ", grey dashes: passage below";
  if (!drawing.uncertain_walls.empty())
    legend +=
        facts.from == "survey" ? ", black dashes: walls not measured" : ", black dashes: limit of sight";
  if (!drawing.paths.empty()) legend += ", thin: flown path";
  if (!drawing.keep_in.empty()) legend += ", green dash-dotted: keep in";
  if (!drawing.keep_out.empty()) legend += ", red hatched: keep out";
  if (leads_on) legend += ", ?: leads on";
  if (joints) legend += ", same letters: same place";
  return cut_to(legend, 2.2, frame.width_mm);
}

/// Which way a profile looks: what is to its left and to its right.
std::string side_names(const Drawing& drawing, const Frame& frame) {
  if (drawing.view != View::projected_profile) return "";
  const double y = frame.top_mm + 5;
  return text({frame.left_mm + 2, y}, degrees_text(drawing.bearing_rad + std::numbers::pi),
              {3, Anchor::start, true, true}) +
         text({frame.left_mm + frame.width_mm - 2, y}, degrees_text(drawing.bearing_rad),
              {3, Anchor::end, true, true});
}

std::string title_block(const Drawing& drawing, const CaveFacts& facts, const SheetOptions& options,
                        const Sheet& sheet, double step_m) {
  const double left = sheet.width_mm - sheet.frame.left_mm - sheet.frame.width_mm;  // the margin
  const double width = sheet.width_mm - 2 * left, top = sheet.title_top_mm,
               height = sheet.height_mm - left - top;
  const double x = left + kPad_mm;
  const double figures = left + 0.46 * width, bar = left + 0.64 * width, arrow = left + width - 9;
  std::string out = box(left, top, width, height, " class=\"title\" fill=\"none\"" + stroke("#000000", 0.35));
  out += text({x, top + 8.5}, cut_to(facts.name, 5.6, figures - x - 2), {5.6, Anchor::start, true});
  out += text({x, top + 15}, cut_to(view_title(drawing), 3.6, figures - x - 2), {3.6});
  out +=
      text({x, top + 21},
           facts.from == "flight" ? "explored by karst" : "from a " + facts.from + ", drawn by karst", {2.8});
  double y = top + 6.5;
  for (const std::string& line : fact_lines(facts)) {
    out += text({figures, y}, cut_to(line, 2.8, bar - figures - 2), {2.8});
    y += 4.6;
  }
  out += text({bar, top + 7.5}, core::format_text("1:%g", sheet.frame.scale), {4.4, Anchor::start, true});
  out += scale_bar({bar + 1, top + 11}, sheet.frame.scale, arrow - 12 - bar);
  if (drawing.view == View::plan) out += north_arrow({arrow, top + 16}, -options.declination_rad);
  const double rule = top + height - 6;
  out += straight({left, rule}, {left + width, rule}, stroke("#000000", 0.15));
  return out + text({x, top + height - 2}, legend_text(drawing, facts, sheet.frame, step_m), {2.2});
}

std::string head(double width_mm, double height_mm, const std::string& label) {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"cave-drawing\" role=\"img\" aria-label=\"" +
         core::xml_text(label) + "\" width=\"" + mm(width_mm) + "mm\" height=\"" + mm(height_mm) +
         "mm\" viewBox=\"0 0 " + mm(width_mm) + " " + mm(height_mm) +
         "\" font-family=\"Helvetica, Arial, sans-serif\">\n";
}

}  // namespace

std::string svg_sheet(const Drawing& drawing, const CaveFacts& facts, const SheetOptions& options,
                      const std::string& file) {
  const Sheet sheet = fitted_sheet(extent_of(drawing, file), options, file);
  const double step_m = grid_step_m(sheet.frame.scale, kGridLeast_mm);
  return head(sheet.width_mm, sheet.height_mm, facts.name + ": " + view_title(drawing)) +
         box(0, 0, sheet.width_mm, sheet.height_mm, " fill=\"#ffffff\"") +
         inside_frame(drawing, sheet.frame, step_m) + grid_numbers(sheet.frame, step_m) +
         side_names(drawing, sheet.frame) + title_block(drawing, facts, options, sheet, step_m) + "</svg>\n";
}

}  // namespace karst::cave_drawing
