#include "sdk/evaluation/record/run_record.h"

#include <algorithm>
#include <boost/property_tree/ptree.hpp>
#include <cmath>
#include <fstream>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "core_stack/common/json_text.h"
#include "core_stack/common/options.h"
#include "sdk/evaluation/record/lines.h"

namespace karst::evaluation {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;
namespace event = core::event;

/// From the phase events, or else from the telemetry's phase column.
std::vector<Phase> find_phases(const RunRecord& run) {
  std::vector<Phase> phases;
  const auto enter = [&](const std::string& name, double t_s) {
    if (!phases.empty() && phases.back().name == name) return;
    if (!phases.empty()) phases.back().end_s = t_s;
    phases.push_back({name, t_s, t_s});
  };
  for (const json& e : run.events) {
    if (const auto phase = event::as<event::Phase>(e)) enter(core::name_of(phase->phase), e["t"]);
    if (event::as<event::Outcome>(e) && !phases.empty()) enter(core::name_of(core::Phase::done), e["t"]);
  }
  if (phases.empty()) {
    const auto* t_s = run.telemetry.times();
    const auto names = run.telemetry.text.find("phase");
    if (t_s && names != run.telemetry.text.end())
      for (std::size_t i = 0; i < t_s->size(); ++i) enter(names->second[i], (*t_s)[i]);
  }
  if (!phases.empty() && !phases.back().is(core::Phase::done)) phases.back().end_s = run.last_time_s();
  std::erase_if(phases, [](const Phase& p) { return p.is(core::Phase::done); });
  return phases;
}

void note_absent(const RunRecord& run, const char* file, const char* consequence,
                 std::vector<std::string>& problems) {
  if (!fs::exists(run.directory / file))
    problems.push_back(std::string(file) + ": not there; " + consequence);
}

std::vector<json> read_flight_events(const fs::path& run_dir, std::vector<std::string>& problems) {
  return read_events(run_dir / "events.jsonl", "t", "kind", problems,
                     [](const json& line) { event::read(line); });
}

void check_stamped(const json& line, const char* time, const char* kind) {
  if (!line.is_object() || !event_number(line, time) || event_text(line, kind).empty())
    throw event::Malformed(std::string("is not an event (a JSON object with \"") + time + "\" and \"" + kind +
                           "\")");
  if (std::abs(*event_number(line, time)) > kLongestRun_s)
    throw event::Malformed(std::string("its \"") + time + "\" is longer than a mission can last");
}

}  // namespace

std::string event_text(const json& event, const char* key) {
  const auto found = event.find(key);
  return found != event.end() && found->is_string() ? found->get<std::string>() : "";
}

std::optional<double> event_number(const json& event, const char* key) {
  const auto found = event.find(key);
  if (found == event.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

std::string RunRecord::setting(const std::string& key) const {
  for (const Setting& s : settings)
    if (s.key == key) return s.value;
  return "";
}

std::optional<double> RunRecord::number(const std::string& key) const {
  const std::string text = setting(key);
  double value = 0;
  if (text.empty() || !parse_number(text.substr(0, text.find(' ')), value)) return std::nullopt;
  return value;
}

double RunRecord::map_resolution_m() const {
  const double r = number("map.resolution").value_or(0.2);
  return r > 0 ? r : 0.2;
}

double RunRecord::last_time_s() const {
  double last = 0;
  for (const json& e : events) last = std::max(last, e["t"].get<double>());
  for (const Table* table : {&telemetry, &truth_table})
    if (const auto* t_s = table->times(); t_s && !t_s->empty()) last = std::max(last, t_s->back());
  if (!estimate.empty()) last = std::max(last, estimate.back().t_s);
  return last;
}

std::vector<Setting> read_settings(const fs::path& file, std::vector<std::string>& problems) {
  std::vector<Setting> settings;
  if (!fs::exists(file)) return settings;
  try {
    for (auto& [key, value] : core::leaves_of(core::read_info(file.string())))
      settings.push_back({std::move(key), std::move(value)});
  } catch (const core::InputError& e) {
    problems.push_back(e.what());
  }
  return settings;
}

json read_json(const fs::path& file, std::vector<std::string>& problems) {
  if (!fs::exists(file)) return nullptr;
  try {
    json value = core::json_of(core::read_input(file, core::kMaxTextFileBytes));
    if (!value.is_discarded()) return value;
    problems.push_back(file.filename().string() + ": is not valid JSON; left out");
  } catch (const core::InputError& e) {
    problems.push_back(e.what());
  }
  return nullptr;
}

std::vector<json> read_events(const fs::path& file, const char* time, const char* kind,
                              std::vector<std::string>& problems,
                              const std::function<void(const json&)>& check) {
  std::vector<json> events;
  BadLines bad(file);
  const std::vector<std::string> lines = read_lines(file, problems);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    json line = core::json_of(lines[i]);
    try {
      check_stamped(line, time, kind);
      check(line);
      events.push_back(std::move(line));
    } catch (const event::Malformed& e) {
      bad.add(i + 1, e.what());
    }
  }
  bad.report(problems);
  return events;
}

RunRecord read_run(const fs::path& run_dir) {
  if (!fs::is_directory(run_dir)) throw core::InputError(run_dir.string(), "", "no such run directory");
  RunRecord run;
  run.directory = run_dir;
  auto& problems = run.problems;
  note_absent(run, "mission.info", "settings are not known", problems);
  note_absent(run, "events.jsonl", "phases, goals and decisions are not known", problems);
  note_absent(run, "telemetry.csv", "speed, battery and volume over time are not known", problems);
  note_absent(run, "trajectory.tum", "the estimated trajectory is not known", problems);
  note_absent(run, "map_growth.bin", "the map cannot be drawn", problems);
  note_absent(run, "map.bt", "the run did not come to its end; the volume is the telemetry's last", problems);
  run.settings = read_settings(run_dir / "mission.info", problems);
  run.events = read_flight_events(run_dir, problems);
  run.truth_events = read_events(run_dir / "truth_events.jsonl", "time_s", "event", problems);
  run.truth_objects = read_events(run_dir / "truth_objects.jsonl", "time_s", "event", problems);
  run.estimate = read_tum(run_dir / "trajectory.tum", problems);
  run.truth = read_tum(run_dir / "ground_truth.tum", problems);
  if (fs::exists(run_dir / "trajectory_odometry.tum"))
    run.odometry = read_tum(run_dir / "trajectory_odometry.tum", problems);
  // A replay keeps its recording's own time base there; all other files count from the recording's begin.
  const double origin_s = run.number("replay.time_origin").value_or(0);
  for (auto* poses : {&run.estimate, &run.truth, &run.odometry})
    for (StampedPose& p : *poses) p.t_s -= origin_s;
  run.telemetry = read_table(run_dir / "telemetry.csv", {"phase"}, problems);
  run.truth_table = read_table(run_dir / "truth.csv", {}, problems);
  run.decisions = read_table(run_dir / "decisions.csv", {}, problems);
  run.unsurveyed = read_table(run_dir / "unsurveyed.csv", {}, problems);
  run.loops = read_table(run_dir / "loops.csv", {"state"}, problems);
  run.growth = read_map_growth(run_dir / "map_growth.bin", problems);
  run.timing = read_json(run_dir / "timing.json", problems);
  run.evaluation = read_json(run_dir / "evaluation.json", problems);
  run.phases = find_phases(run);
  return run;
}

RunRecord read_events_alone(const fs::path& run_dir) {
  RunRecord run;
  run.directory = run_dir;
  run.events = read_flight_events(run_dir, run.problems);
  run.phases = find_phases(run);
  return run;
}

}  // namespace karst::evaluation
