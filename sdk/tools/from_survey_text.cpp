#include "sdk/tools/from_survey_text.h"

#include <algorithm>

#include "core_stack/common/character_count.h"
#include "core_stack/common/counted.h"
#include "core_stack/common/csv_cell.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/json_point.h"
#include "plugins/simulator/cave/propose_start.h"

namespace karst::tools {
namespace {

using core::counted;
using core::format_text;
using nlohmann::ordered_json;
using survey::Survey;
using survey_cave::CaveFromSurvey;
using survey_cave::SurveyReport;

constexpr std::size_t kMostRows = 10;  // of each list on the screen

double percent_of(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

/// The first rows of a list, and how many more there are.
template <class List, class Text>
void add_rows(std::vector<std::string>& lines, const List& list, const Text& text) {
  for (std::size_t i = 0; i < list.size() && i < kMostRows; ++i) lines.push_back("  " + text(list[i]));
  if (list.size() > kMostRows)
    lines.push_back(format_text("  and %zu more; --json lists all", list.size() - kMostRows));
}

std::string named(const std::string& survey) { return survey.empty() ? "(no survey)" : survey; }

std::string loop_text(const survey::Loops::Traverse& t) {
  std::string text = format_text("%8.2f m, %6.2f %% of %.0f m, %s to %s", t.error_m, t.error_percent,
                                 t.length_m, t.from.c_str(), t.to.c_str());
  if (t.sigmas) text += format_text(", %.1f standard deviations", *t.sigmas);
  return text;
}

void add_guesses(std::vector<std::string>& lines, const SurveyReport& r) {
  lines.push_back(format_text(
      "not measured       %.0f m of passage without dimensions, %.1f %%; %.0f m with some of them",
      r.dimensions.without_m, percent_of(r.dimensions.without_m, r.passage_m), r.dimensions.partly_m));
  if (r.dimensions.without_m + r.dimensions.partly_m > 0)
    lines.push_back(format_text("  interpolated along the passages; %.0f m without any neighbour to go by",
                                r.dimensions.defaults_m));
  add_rows(lines, r.dimensions.guessed, [](const survey_cave::GuessedSurvey& g) {
    return format_text("%8.0f m without, %6.0f m partly, of %.0f m: ", g.without_m, g.partly_m, g.legs_m) +
           named(g.name);
  });
  if (r.dimensions.splays_m > 0)
    lines.push_back(
        format_text("splays             %zu; they shape %.0f m of passage", r.splays, r.dimensions.splays_m));
  if (r.dimensions.shafts_m > 0)
    lines.push_back(
        format_text("shafts             %.0f m, whose front and back are guessed from left and right",
                    r.dimensions.shafts_m));
  if (r.dimensions.widened_m > 0)
    lines.push_back(
        format_text("widened            %.0f m of passage, to %.2g m: the grid shows nothing narrower",
                    r.dimensions.widened_m, r.dimensions.least_m));
}

void add_obstacles(std::vector<std::string>& lines, const SurveyReport& r) {
  lines.push_back(format_text("narrow             %.0f m of passage are narrower or lower than %.2g m",
                              r.obstacles.narrow_m, r.obstacles.vehicle_width_m));
  if (r.obstacles.within_reach_m)
    lines.push_back(
        format_text("within reach       %.0f m, %.1f %% of the passages, from the start and through "
                    "nothing narrower",
                    *r.obstacles.within_reach_m, percent_of(*r.obstacles.within_reach_m, r.passage_m)));
  if (r.obstacles.flooded_m > 0)
    lines.push_back(
        format_text("flooded            %.0f m were dived; the cave has air there", r.obstacles.flooded_m));
  if (!r.obstacles.blocked.empty())
    lines.push_back("blocked            " + counted(r.obstacles.blocked.size(), "station") +
                    " whose comment names a sump or a choke; the cave is open there");
  add_rows(lines, r.obstacles.blocked, [](const survey_cave::Blocked& b) {
    return b.station + ": " + std::string(core::first_characters(b.comment, 60));
  });
  if (!r.obstacles.continuations.empty())
    lines.push_back("goes on            at " + counted(r.obstacles.continuations.size(), "station"));
  add_rows(lines, r.obstacles.continuations, [](const std::string& name) { return name; });
  lines.push_back("connected          " + counted(r.parts.size(), "part"));
  if (r.parts.size() > 1)
    add_rows(lines, r.parts, [](const survey_cave::ConnectedPart& p) {
      return format_text("%8.0f m, %zu stations, such as ", p.legs_m, p.stations) + p.station;
    });
  if (r.walls.stations_in_rock > 0)
    lines.push_back("in rock            " + counted(r.walls.stations_in_rock, "station") +
                    " whose legs have no length, such as " + r.walls.bare_stations.front());
}

std::string flags_of(const survey::Station& s) {
  std::string flags;
  const auto add = [&](bool is, const char* name) {
    if (is) flags += (flags.empty() ? "" : " ") + std::string(name);
  };
  add(s.entrance, "entrance");
  add(s.fixed, "fixed");
  add(s.continuation, "continuation");
  return flags;
}

}  // namespace

std::vector<std::string> survey_lines(const Survey& survey, const CaveFromSurvey& made,
                                      std::uintmax_t mesh_bytes) {
  const SurveyReport& r = made.report;
  std::vector<std::string> lines;
  lines.push_back(
      format_text("passages           %.0f m in %zu legs, %zu stations, %s, %.0f m from the highest "
                  "to the lowest",
                  r.passage_m, r.legs, r.stations, counted(r.entrances, "entrance").c_str(), r.depth_m));
  lines.push_back(
      format_text("left out           %.0f m on the surface, %.0f m of duplicates, %.0f m in other "
                  "parts of the survey",
                  r.surface_m, r.duplicate_m, r.rest_m));
  if (const survey::LeftOut& out = survey.left_out; out.parts > 0)
    lines.push_back("left out           " + counted(out.parts, "part") +
                    format_text(", %.0f m in ", out.legs_m) + counted(out.legs, "leg") +
                    ", that no leg or equate ties to the rest");
  lines.push_back(
      format_text("walls              %zu triangles, %.0f m2, closed; enclose %.0f m3; grid %g m, "
                  "roughness %g m; %.1f MB",
                  r.walls.triangles, r.walls.surface_m2, r.walls.volume_m3, r.walls.resolution_m,
                  r.walls.roughness_m, static_cast<double>(mesh_bytes) / 1e6));
  if (!r.offset_m.isZero())
    lines.push_back(format_text("origin             at \"%.0f %.0f %.0f\" of the survey", r.offset_m.x(),
                                r.offset_m.y(), r.offset_m.z()));
  lines.push_back("loops              " + counted(survey.loops.count, "loop") + " in the survey" +
                  (survey.loops.traverses.empty() ? "" : "; the largest errors of traverses:"));
  add_rows(lines, survey.loops.traverses, loop_text);
  add_guesses(lines, r);
  add_obstacles(lines, r);
  for (const std::string& f : r.findings) lines.push_back("check              " + f);
  if (!survey.notes.empty())
    lines.push_back("notes              " + counted(survey.notes.size() + survey.notes_left_out, "note") +
                    " of the survey's reader");
  add_rows(lines, survey.notes, [&](const survey::Note& n) {
    const std::string place = survey::place_of(survey, n.source);
    return (place.empty() ? "" : place + ": ") + n.text +
           (n.more > 0 ? format_text(" (and of %zu more lines)", n.more) : "");
  });
  lines.push_back("start              " + (made.start ? cave::start_text(*made.start)
                                                      : std::string("none found that suits: give --start")));
  return lines;
}

ordered_json survey_json(const Survey& survey, const CaveFromSurvey& made, std::uintmax_t mesh_bytes) {
  const SurveyReport& r = made.report;
  ordered_json j{{"schema", "karst.from_survey/1"},
                 {"title", survey.title},
                 {"passage_m", r.passage_m},
                 {"legs", r.legs},
                 {"stations", r.stations},
                 {"entrances", r.entrances},
                 {"depth_m", r.depth_m},
                 {"surface_legs_m", r.surface_m},
                 {"duplicate_legs_m", r.duplicate_m},
                 {"other_parts_of_survey_m", r.rest_m},
                 {"loose_parts", survey.left_out.parts},
                 {"loose_legs", survey.left_out.legs},
                 {"loose_legs_m", survey.left_out.legs_m},
                 {"offset_m", core::list(r.offset_m)},
                 {"resolution_m", r.walls.resolution_m},
                 {"roughness_m", r.walls.roughness_m},
                 {"triangles", r.walls.triangles},
                 {"mesh_bytes", mesh_bytes},
                 {"surface_m2", r.walls.surface_m2},
                 {"volume_m3", r.walls.volume_m3},
                 {"without_dimensions_m", r.dimensions.without_m},
                 {"partly_without_dimensions_m", r.dimensions.partly_m},
                 {"without_neighbours_m", r.dimensions.defaults_m},
                 {"median_half_width_m", r.dimensions.half_width_m},
                 {"median_up_m", r.dimensions.up_m},
                 {"median_down_m", r.dimensions.down_m},
                 {"splays", r.splays},
                 {"sections_from_splays", r.dimensions.sections_from_splays},
                 {"shaped_by_splays_m", r.dimensions.splays_m},
                 {"shafts_m", r.dimensions.shafts_m},
                 {"widened_m", r.dimensions.widened_m},
                 {"least_width_m", r.dimensions.least_m},
                 {"vehicle_width_m", r.obstacles.vehicle_width_m},
                 {"narrow_m", r.obstacles.narrow_m},
                 {"flooded_m", r.obstacles.flooded_m},
                 {"stations_in_rock", r.walls.stations_in_rock}};
  j["within_reach_m"] =
      r.obstacles.within_reach_m ? ordered_json(*r.obstacles.within_reach_m) : ordered_json();
  j["guessed"] = ordered_json::array();
  for (const survey_cave::GuessedSurvey& g : r.dimensions.guessed)
    j["guessed"].push_back(
        {{"survey", g.name}, {"legs_m", g.legs_m}, {"without_m", g.without_m}, {"partly_m", g.partly_m}});
  j["blocked"] = ordered_json::array();
  for (const survey_cave::Blocked& b : r.obstacles.blocked)
    j["blocked"].push_back({{"station", b.station}, {"comment", b.comment}});
  j["continuations"] = r.obstacles.continuations;
  j["parts"] = ordered_json::array();
  for (const survey_cave::ConnectedPart& p : r.parts)
    j["parts"].push_back({{"station", p.station}, {"stations", p.stations}, {"legs_m", p.legs_m}});
  j["loops"] = survey.loops.count;
  j["traverses"] = ordered_json::array();
  for (const survey::Loops::Traverse& t : survey.loops.traverses) {
    j["traverses"].push_back({{"from", t.from},
                              {"to", t.to},
                              {"legs", t.legs},
                              {"length_m", t.length_m},
                              {"error_m", t.error_m},
                              {"error_percent", t.error_percent}});
    if (t.sigmas) j["traverses"].back()["sigmas"] = *t.sigmas;
  }
  j["findings"] = r.findings;
  j["notes"] = ordered_json::array();
  for (const survey::Note& n : survey.notes)
    j["notes"].push_back(
        {{"place", survey::place_of(survey, n.source)}, {"text", n.text}, {"more_lines", n.more}});
  j["notes_left_out"] = survey.notes_left_out;
  j["start"] = made.start ? ordered_json(cave::start_text(*made.start)) : ordered_json();
  return j;
}

std::string stations_csv(const Survey& survey, const CaveFromSurvey& made) {
  std::string text = "name,x,y,z,flags\n";
  for (const survey_cave::KeptStation& k : made.stations) {
    const survey::Station& s = survey.stations[k.station];
    text += core::csv_cell(s.name) +
            format_text(",%.3f,%.3f,%.3f,", k.position_m.x(), k.position_m.y(), k.position_m.z()) +
            flags_of(s) + "\n";
  }
  return text;
}

}  // namespace karst::tools
