#include "sdk/evaluation/report/team_report.h"

#include <algorithm>
#include <fstream>

#include "core_stack/common/json_file.h"
#include "core_stack/common/json_text.h"
#include "sdk/evaluation/metrics/flight_figures.h"
#include "sdk/evaluation/metrics/summary.h"
#include "sdk/evaluation/record/whole_file.h"
#include "sdk/evaluation/report/report_curve.h"
#include "sdk/evaluation/report/report_scene.h"
#include "sdk/evaluation/report/report_units.h"

namespace karst::evaluation {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;
namespace event = core::event;
using event::is_kind;

constexpr std::size_t kTrackPoses = 3000;  // per robot

bool is_numbers(const json& list, std::size_t least) {
  return list.is_array() && list.size() >= least &&
         std::all_of(list.begin(), list.end(), [](const json& v) { return v.is_number(); });
}

/// The lists of numbers in a field, each at least `least` long. Invalid ones are left out and counted.
ordered_json number_lists(const json& event, const char* key, std::size_t least, std::size_t& damaged) {
  ordered_json out = ordered_json::array();
  const auto field = event.find(key);
  if (field == event.end() || !field->is_array()) {
    ++damaged;
    return out;
  }
  for (const json& list : *field) {
    if (is_numbers(list, least))
      out.push_back(ordered_json(list));
    else
      ++damaged;
  }
  return out;
}

/// [[robot, [x, y, z]], ...] as [[robot, x, y, z], ...].
ordered_json places(const json& event, const char* key, std::size_t& damaged) {
  ordered_json out = ordered_json::array();
  const auto field = event.find(key);
  if (field == event.end() || !field->is_array()) return out;
  for (const json& p : *field) {
    if (p.is_array() && p.size() == 2 && p[0].is_number() && is_numbers(p[1], 3))
      out.push_back({p[0], p[1][0], p[1][1], p[1][2]});
    else
      ++damaged;
  }
  return out;
}

ordered_json plain_numbers(const json& event, const char* key, std::size_t& damaged) {
  const auto field = event.find(key);
  if (field != event.end() && is_numbers(*field, 0)) return *field;
  ++damaged;
  return ordered_json::array();
}

/// The base's knowledge and the homing tree as reported to it, over time.
void add_base(ordered_json& d, const TeamRecord& team, std::vector<std::string>& problems) {
  std::size_t damaged = 0;
  ordered_json moments = ordered_json::array(), tree = ordered_json::array();
  ordered_json position = nullptr, reach = nullptr;
  for (const json& e : team.events) {
    if (e["kind"] == "team") {
      if (e.contains("base") && is_numbers(e["base"], 3)) position = e["base"];
      if (const auto m = event_number(e, "reach")) reach = *m;
    } else if (e["kind"] == "base") {
      moments.push_back({e["t"],
                         {{"connected", plain_numbers(e, "connected", damaged)},
                          {"links", number_lists(e, "links", 3, damaged)},
                          {"held", number_lists(e, "held", 2, damaged)},
                          {"relays", places(e, "relays", damaged)},
                          {"dead", plain_numbers(e, "dead", damaged)}}});
    } else if (e["kind"] == "tree") {
      tree.push_back({e["t"], number_lists(e, "nodes", 6, damaged)});
    }
  }
  if (damaged > 0)
    problems.push_back("team.jsonl: " + std::to_string(damaged) +
                       " fields of what the base knew are missing or damaged; left out");
  d["base"] = {{"position", position}, {"reach_m", reach}, {"moments", std::move(moments)}};
  d["tree"] = std::move(tree);
}

ordered_json robot_data(const RunRecord& r, const Ending& ending) {
  const Table& t = r.telemetry;
  ordered_json d;
  d["phases"] = ordered_json::array();
  for (const Phase& p : r.phases) d["phases"].push_back({p.name, p.begin_s, p.end_s});
  d["track"] = scene_track(r.estimate.empty() ? r.truth : r.estimate, kTrackPoses);
  d["battery"] = report_curve(t.times(), t.column("battery_fraction"), 100);
  d["volume"] = report_curve(t.times(), t.column("explored_m3"));
  d["reported"] = std::filesystem::exists(r.directory / "report.html");
  d["ending"] = ending.sentence;
  return d;
}

/// All events except those that are drawn instead.
ordered_json event_rows(const TeamRecord& team) {
  ordered_json rows = ordered_json::array();
  for (const json& e : team.events)
    if (e["kind"] != "base" && e["kind"] != "tree" && e["kind"] != "traffic") rows.push_back(ordered_json(e));
  for (std::size_t i = 0; i < team.robots.size(); ++i)
    for (const json& e : team.robots[i].events)
      if (is_kind(e, event::Homing::kKind) || is_kind(e, event::Landing::kKind) ||
          is_kind(e, event::Team::kKind) || is_kind(e, event::Safety::kKind)) {
        rows.push_back(ordered_json(e));
        rows.back()["robot"] = i + 1;
        if (is_kind(e, event::Team::kKind)) rows.back()["kind"] = "keep apart";
        if (e.contains("robot")) rows.back()["with"] = e["robot"];
      }
  std::stable_sort(rows.begin(), rows.end(), [](const ordered_json& a, const ordered_json& b) {
    return a["t"].get<double>() < b["t"].get<double>();
  });
  return rows;
}

}  // namespace

ordered_json team_report_data(const TeamRecord& team, const ordered_json& metrics) {
  const double duration_s = std::max(1.0, team.duration_s);
  std::vector<std::string> problems = team.problems;
  for (const RunRecord& r : team.robots)
    for (const std::string& p : r.problems) problems.push_back(r.directory.filename().string() + "/" + p);
  std::vector<Ending> endings;
  for (const RunRecord& r : team.robots) endings.push_back(ending_of(r));
  const Ending joint = joint_ending(endings);
  ordered_json d;
  d["metrics"] = metrics;
  d["units"] = metric_units();
  d["summary"] = summary_of(metrics, joint);
  d["as_meant"] = joint.sentence.empty() ? ordered_json(nullptr) : ordered_json(joint.as_meant);
  d["duration_s"] = duration_s;
  d["begin_s"] = flight_begin_s(team.merged);
  d["settings"] = ordered_json::array();
  for (const Setting& s : team.settings) d["settings"].push_back({s.key, s.value});
  d["timing"] = team.timing;
  d["robots"] = ordered_json::array();
  for (std::size_t i = 0; i < team.robots.size(); ++i)
    d["robots"].push_back(robot_data(team.robots[i], endings[i]));
  add_base(d, team, problems);
  d["volume"] = report_curve(team.merged.telemetry.times(), team.merged.telemetry.column("explored_m3"));
  d["events"] = event_rows(team);
  d["cloud"] = scene_cloud(team.merged, duration_s, problems);
  d["cave_drawings"]["note"] = "The report of each robot has the drawings of its own map.";
  d["problems"] = problems;
  return d;
}

void write_team_report(const TeamRecord& team, const ordered_json& metrics) {
  write_whole_file(team.directory / "report.html", team_report_page(team_report_data(team, metrics)));
}

void write_team_report(const std::filesystem::path& run_dir) {
  const TeamRecord team = read_team(run_dir);
  const auto metrics = core::json_of_file<ordered_json>(run_dir / "metrics.json");
  write_team_report(team, metrics.is_object() ? metrics : ordered_json::object());
}

}  // namespace karst::evaluation
