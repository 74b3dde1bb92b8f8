#include <algorithm>
#include <cmath>

#include "sdk/evaluation/decimate.h"
#include "sdk/evaluation/flight_figures.h"
#include "sdk/evaluation/report.h"
#include "sdk/evaluation/report_scene.h"

namespace karst::evaluation {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::size_t kMaxPlotSamples = 1600;

double thousandths(double v) { return std::round(v * 1000) / 1000; }

/// [[x, y], ...], or null if the record has no such curve.
ordered_json curve(const std::vector<double>* t_s, const std::vector<double>* y, double scale = 1) {
  if (!t_s || !y) return nullptr;
  const Curve c = decimate(*t_s, *y, kMaxPlotSamples);
  if (c.x.empty()) return nullptr;
  ordered_json points = ordered_json::array();
  for (std::size_t i = 0; i < c.x.size(); ++i)
    points.push_back({thousandths(c.x[i]), thousandths(scale * c.y[i])});
  return points;
}

ordered_json curves(const RunRecord& run) {
  const Table& t = run.telemetry;
  const auto* t_s = t.column("t_s");
  std::vector<double> speed;
  if (t_s && t.column("vx") && t.column("vy") && t.column("vz"))
    for (std::size_t i = 0; i < t_s->size(); ++i)
      speed.push_back(std::hypot((*t.column("vx"))[i], (*t.column("vy"))[i], (*t.column("vz"))[i]));
  const auto* truth_s = run.truth_table.column("t_s");
  const auto* decision_s = run.decisions.column("t_s");
  return {{"volume", curve(t_s, t.column("explored_m3"))},
          {"speed", curve(t_s, &speed)},
          {"battery", curve(t_s, t.column("battery_fraction"), 100)},
          {"home", curve(t_s, t.column("home_distance_m"))},
          {"clearance", curve(truth_s, run.truth_table.column("clearance_m"))},
          {"decide", curve(decision_s, run.decisions.column("decide_ms"))},
          {"plan", curve(decision_s, run.decisions.column("plan_ms"))}};
}

bool is_end_of_goal(const std::string& state) {
  return state == "reached" || state == "unreachable" || state == "abandoned" || state == "superseded";
}

/// Accepted goals with the time and manner of their end. A goal ends at the latest with the next one or with
/// the exploration.
ordered_json goals(const RunRecord& run) {
  ordered_json list = ordered_json::array();
  const auto end = [&](double t_s, const std::string& fate, const std::string& reason) {
    if (list.empty() || !list.back()["until"].is_null()) return;
    list.back()["until"] = t_s;
    list.back()["fate"] = fate;
    list.back()["fate_reason"] = reason;
  };
  for (const json& e : run.events) {
    const double t_s = e["t"];
    const std::string state = event_text(e, "state");
    if (e["kind"] == "phase" && event_text(e, "phase") != "explore") end(t_s, "", "");
    if (e["kind"] != "goal") continue;
    if (is_end_of_goal(state)) end(t_s, state, event_text(e, "reason"));
    if (state != "accepted") continue;
    end(t_s, "superseded", "");
    const auto position = e.find("position");
    const bool placed =
        position != e.end() && position->is_array() && position->size() == 3 &&
        std::all_of(position->begin(), position->end(), [](const json& v) { return v.is_number(); });
    list.push_back(
        {{"t", t_s},
         {"until", nullptr},
         {"position", placed ? ordered_json(*position) : ordered_json(nullptr)},
         {"heading", event_number(e, "heading") ? ordered_json(*event_number(e, "heading")) : nullptr},
         {"score", event_number(e, "score") ? ordered_json(*event_number(e, "score")) : nullptr},
         {"why", event_text(e, "why")},
         {"fate", ""},
         {"fate_reason", ""}});
  }
  return list;
}

/// Events for the table: without the bulk that is drawn instead.
ordered_json event_rows(const RunRecord& run) {
  ordered_json rows = ordered_json::array();
  for (const json& e : run.events) {
    if (e["kind"] == "frontiers" || e["kind"] == "drawing") continue;
    ordered_json row = e;
    for (const char* bulk : {"points", "from", "to"}) row.erase(bulk);
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

ordered_json report_data(const RunRecord& run, const ordered_json& metrics) {
  const double duration_s = std::max(1.0, run.last_time_s());
  std::vector<std::string> problems = run.problems;
  ordered_json d;
  d["metrics"] = metrics;
  d["duration_s"] = duration_s;
  d["begin_s"] = flight_begin_s(run);
  d["phases"] = ordered_json::array();
  for (const Phase& p : run.phases) d["phases"].push_back({p.name, p.begin_s, p.end_s});
  d["settings"] = ordered_json::array();
  for (const Setting& s : run.settings) d["settings"].push_back({s.key, s.value});
  d["timing"] = run.timing;
  d["curves"] = curves(run);
  d["goals"] = goals(run);
  d["events"] = event_rows(run);
  d["cloud"] = scene_cloud(run, duration_s, problems);
  d["track"] = scene_track(run.estimate.empty() ? run.truth : run.estimate);
  d["true_track"] = run.estimate.empty() ? ordered_json(nullptr) : scene_track(run.truth);
  d["frontiers"] = scene_frontiers(run, problems);
  d["plans"] = scene_plans(run, problems);
  d["drawings"] = scene_drawings(run, problems);
  d["problems"] = problems;
  return d;
}

}  // namespace karst::evaluation
