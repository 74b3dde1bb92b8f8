#include <algorithm>
#include <cmath>

#include "sdk/evaluation/decisions/goal_spans.h"
#include "sdk/evaluation/metrics/flight_figures.h"
#include "sdk/evaluation/metrics/summary.h"
#include "sdk/evaluation/report/report.h"
#include "sdk/evaluation/report/report_curve.h"
#include "sdk/evaluation/report/report_decisions.h"
#include "sdk/evaluation/report/report_pictures.h"
#include "sdk/evaluation/report/report_scene.h"
#include "sdk/evaluation/report/report_units.h"

namespace karst::evaluation {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

ordered_json curves(const RunRecord& run) {
  const Table& t = run.telemetry;
  const auto* t_s = t.times();
  std::vector<double> speed;
  if (t_s && t.column("vx") && t.column("vy") && t.column("vz"))
    for (std::size_t i = 0; i < t_s->size(); ++i)
      speed.push_back(std::hypot((*t.column("vx"))[i], (*t.column("vy"))[i], (*t.column("vz"))[i]));
  std::vector<double> distance;
  if (t_s && !t_s->empty() && t.column("x") && t.column("y") && t.column("z"))
    for (std::size_t i = 0; i < t_s->size(); ++i) {
      const auto from_first = [&](const char* axis) {
        return (*t.column(axis))[i] - t.column(axis)->front();
      };
      distance.push_back(std::hypot(from_first("x"), from_first("y"), from_first("z")));
    }
  const auto* truth_s = run.truth_table.times();
  const auto* decision_s = run.decisions.times();
  return {{"volume", report_curve(t_s, t.column("explored_m3"))},
          {"speed", report_curve(t_s, &speed)},
          {"battery", report_curve(t_s, t.column("battery_fraction"), 100)},
          {"distance", report_curve(t_s, &distance)},
          {"clearance", report_curve(truth_s, run.truth_table.column("clearance_m"))},
          {"decide", report_curve(decision_s, run.decisions.column("decide_ms"))},
          {"plan", report_curve(decision_s, run.decisions.column("plan_ms"))}};
}

/// Events for the table, without the bulk data that is drawn instead.
ordered_json event_rows(const RunRecord& run) {
  ordered_json rows = ordered_json::array();
  for (const json& e : run.events) {
    if (core::event::is_kind(e, core::event::Frontiers::kKind) ||
        core::event::is_kind(e, core::event::Drawing::kKind))
      continue;
    ordered_json row = e;
    for (const char* bulk : {"points", "from", "to"}) row.erase(bulk);
    rows.push_back(std::move(row));
  }
  for (const json& e : run.truth_events) {
    const std::string detail = event_text(e, "detail");
    rows.push_back({{"t", e["time_s"]},
                    {"kind", "truth"},
                    {"text", event_text(e, "event") + (detail.empty() ? "" : ": " + detail)}});
  }
  std::stable_sort(rows.begin(), rows.end(), [](const ordered_json& a, const ordered_json& b) {
    return a["t"].get<double>() < b["t"].get<double>();
  });
  return rows;
}

}  // namespace

ordered_json report_data(const RunRecord& run, const ordered_json& metrics) {
  const double duration_s = std::max(1.0, run.last_time_s());
  std::vector<std::string> problems = run.problems;
  const Ending ending = ending_of(run);
  ordered_json d;
  d["metrics"] = metrics;
  d["units"] = metric_units();
  d["summary"] = summary_of(metrics, ending);
  d["as_meant"] = ending.sentence.empty() ? ordered_json(nullptr) : ordered_json(ending.as_meant);
  d["duration_s"] = duration_s;
  d["begin_s"] = flight_begin_s(run);
  d["phases"] = ordered_json::array();
  for (const Phase& p : run.phases) d["phases"].push_back({p.name, p.begin_s, p.end_s});
  d["settings"] = ordered_json::array();
  for (const Setting& s : run.settings) d["settings"].push_back({s.key, s.value});
  d["timing"] = run.timing;
  d["curves"] = curves(run);
  d["errors"] = run.evaluation;
  d["goals"] = goal_spans(run);
  d["choices"] = decision_choices(run, problems);
  d["events"] = event_rows(run);
  d["cloud"] = scene_cloud(run, duration_s, problems);
  d["track"] = scene_track(run.estimate.empty() ? run.truth : run.estimate);
  d["true_track"] = run.estimate.empty() ? ordered_json(nullptr) : scene_track(run.truth);
  d["odometry_track"] = scene_track(run.odometry);
  d["loops"] = scene_loops(run);
  d["frontiers"] = scene_frontiers(run, problems);
  d["plans"] = scene_plans(run, problems);
  d["objects"] = scene_objects(run);
  d["region"] = scene_region(run, problems);
  d["drawings"] = scene_drawings(run, problems);
  d["pictures"] = report_pictures(run.directory, problems);
  d["problems"] = problems;
  return d;
}

}  // namespace karst::evaluation
