#include "sdk/tools/from_cloud_text.h"

#include "core_stack/common/counted.h"
#include "core_stack/common/decimal_text.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/json_point.h"
#include "plugins/simulator/cave/propose_start.h"

namespace karst::tools {
namespace {

using core::counted;
using core::format_text;
using from_cloud::CloudReport;
using from_cloud::GuessedPatch;
using from_cloud::NormalsFrom;
using nlohmann::ordered_json;

constexpr std::size_t kMostPatches = 20;  // on the screen

double percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

std::string normals_text(const CloudReport& r) {
  std::string text = r.normals == NormalsFrom::file ? "of the file" : "of planes through neighbours";
  if (r.orientation) {
    const from_cloud::Orientation& o = *r.orientation;
    if (o.seen > 0) text += format_text("; the scanner sees %zu points", o.seen);
    if (o.rays > 0)
      text += format_text("; %.0f %% of %zu rays confirm the side of the air",
                          percent(static_cast<double>(o.agreed), static_cast<double>(o.rays)), o.rays);
  }
  return text + format_text("; %.0f %% agree with their neighbours", 100 * r.agreement);
}

std::string place_text(double area_m2, double diameter_m, const core::Vec3& centre) {
  return format_text("  %8.2f m², %6.2f m across, around ", area_m2, diameter_m) +
         core::decimal_text(centre, 1);
}

ordered_json place_json(double area_m2, double diameter_m, const core::Vec3& centre) {
  return {{"area_m2", area_m2}, {"diameter_m", diameter_m}, {"centre_m", core::list(centre)}};
}

}  // namespace

std::vector<std::string> report_lines(const from_cloud::CaveFromCloud& made, std::uintmax_t mesh_bytes) {
  const CloudReport& r = made.report;
  std::vector<std::string> lines;
  lines.push_back(
      format_text("points             %zu in the file; left out: %zu not finite, %zu withheld, %zu "
                  "without a normal",
                  r.points, r.not_finite, r.withheld, r.without_normal));
  lines.push_back(
      format_text("thinned out        to %zu, one a cell of %g m (spacing %.2f m); %zu far from the "
                  "others left out",
                  r.thinned, r.resolution_m, r.spacing_m, r.lonely));
  lines.push_back("normals            " + normals_text(r));
  lines.push_back(format_text("surface            %zu triangles, %.1f m², closed; encloses %.1f m³; %.1f MB",
                              made.mesh.triangles.size(), r.guessed.whole_m2, r.volume_m3,
                              static_cast<double>(mesh_bytes) / 1e6));
  lines.push_back(
      format_text("left out           %s of surface, %.1f m²; %zu points lie off the cave's surface",
                  counted(r.other_parts, "other part").c_str(), r.other_parts_m2, r.off_surface));
  lines.push_back(
      format_text("guessed            %.1f m², %.1f %% of the surface, farther than %g m from all "
                  "points; %s",
                  r.guessed.area_m2, percent(r.guessed.area_m2, r.guessed.whole_m2), r.guessed_beyond_m,
                  counted(r.guessed.patches.size(), "place").c_str()));
  for (std::size_t i = 0; i < r.guessed.patches.size() && i < kMostPatches; ++i) {
    const GuessedPatch& p = r.guessed.patches[i];
    lines.push_back(place_text(p.area_m2, p.diameter_m, p.centre));
  }
  if (r.guessed.patches.size() > kMostPatches)
    lines.push_back(
        format_text("  and %zu smaller ones; --json lists all", r.guessed.patches.size() - kMostPatches));
  if (!r.holes.empty())
    lines.push_back("holes closed       " + counted(r.holes.size(), "hole") +
                    " that the reconstruction left open");
  for (const cave::BoundaryLoop& h : r.holes) lines.push_back(place_text(h.area_m2, h.diameter_m, h.centre));
  for (const std::string& f : r.findings) lines.push_back("check              " + f);
  lines.push_back("start              " + (made.start ? cave::start_text(*made.start)
                                                      : std::string("none found that suits: give --start")));
  return lines;
}

ordered_json report_json(const from_cloud::CaveFromCloud& made, std::uintmax_t mesh_bytes) {
  const CloudReport& r = made.report;
  ordered_json j{{"schema", "karst.from_cloud/1"},     {"points", r.points},
                 {"not_finite", r.not_finite},         {"withheld", r.withheld},
                 {"without_normal", r.without_normal}, {"spacing_m", r.spacing_m},
                 {"resolution_m", r.resolution_m},     {"thinned_points", r.thinned},
                 {"lonely_points", r.lonely},          {"points_off_surface", r.off_surface},
                 {"normals", core::name_of(r.normals)}};
  if (r.orientation) {
    j["points_seen"] = r.orientation->seen;
    j["rays"] = r.orientation->rays;
    j["rays_agreed"] = r.orientation->agreed;
  }
  j["normals_agreement"] = r.agreement;
  j["triangles"] = made.mesh.triangles.size();
  j["mesh_bytes"] = mesh_bytes;
  j["surface_m2"] = r.guessed.whole_m2;
  j["volume_m3"] = r.volume_m3;
  j["other_parts"] = r.other_parts;
  j["other_parts_m2"] = r.other_parts_m2;
  j["guessed_beyond_m"] = r.guessed_beyond_m;
  j["guessed_m2"] = r.guessed.area_m2;
  j["guessed"] = ordered_json::array();
  for (const GuessedPatch& p : r.guessed.patches)
    j["guessed"].push_back(place_json(p.area_m2, p.diameter_m, p.centre));
  j["holes_closed"] = ordered_json::array();
  for (const cave::BoundaryLoop& h : r.holes)
    j["holes_closed"].push_back(place_json(h.area_m2, h.diameter_m, h.centre));
  j["findings"] = r.findings;
  j["start"] = made.start ? ordered_json(cave::start_text(*made.start)) : ordered_json();
  return j;
}

}  // namespace karst::tools
