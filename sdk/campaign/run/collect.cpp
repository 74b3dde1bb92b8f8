#include "sdk/campaign/run/collect.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>

#include "core_stack/common/input_file.h"
#include "core_stack/common/json_file.h"
#include "sdk/campaign/run/executor.h"
#include "sdk/evaluation/metrics/coverage_curve.h"
#include "sdk/evaluation/metrics/metric_definitions.h"
#include "sdk/evaluation/team/run_ending.h"

namespace karst::campaign {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kCurveStep_s = 2;  // between points of a curve: 150 for five minutes
constexpr std::size_t kLongestReason = 500;

json read_json(const fs::path& file) { return fs::exists(file) ? core::json_of_file(file) : json(); }

std::string text_of(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

double number_of(const json& object, std::string_view key) {
  const auto found = object.find(std::string(key));
  return found != object.end() && found->is_number() ? found->get<double>() : kUnknown;
}

/// The last line a trial printed; for one that could not fly, this is the reason.
std::string last_words(const fs::path& run_dir) {
  if (!fs::is_regular_file(run_dir / kLogFile)) return "";
  std::ifstream in = core::open_input(run_dir / kLogFile, core::kMaxDataFileBytes);
  std::string last;
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) last = line;
  return last.substr(0, kLongestReason);
}

std::string failure(const Plan& plan, const fs::path& run_dir, ProcessEnd end) {
  end.wall_s = plan.trial_timeout_s;  // the limit, not the measured time: reasons must be reproducible
  std::string words = last_words(run_dir);
  if (words.starts_with("karst: ")) words = words.substr(7);
  if (end.exit_code == 1 && !words.empty()) return words;
  return describe(end) + (words.empty() ? "" : "; it said last: " + words);
}

/// Resamples the curve: each step holds the last point until then.
std::vector<CurvePoint> curve_of(const evaluation::RunRecord& run, double coverage) {
  const auto fine =
      evaluation::coverage_curve(run, std::isfinite(coverage) ? std::optional(coverage) : std::nullopt);
  std::vector<CurvePoint> curve;
  const auto next_s = [&curve] { return static_cast<double>(curve.size()) * kCurveStep_s; };
  for (std::size_t i = 0; i + 1 < fine.size(); ++i)
    while (fine[i + 1].time_s > next_s()) curve.push_back({next_s(), fine[i].explored_m3, fine[i].coverage});
  if (!fine.empty()) curve.push_back({fine.back().time_s, fine.back().explored_m3, fine.back().coverage});
  return curve;
}

}  // namespace

fs::path run_dir_of(const Plan& plan, const TrialKey& trial) {
  const auto& [contestant, cave, seed] = trial;
  return fs::path("trials") / plan.contestants.at(contestant).name / plan.caves.at(cave).name /
         std::to_string(seed);
}

StoredTrial collect(const Plan& plan, const TrialKey& key, const fs::path& folder) {
  const fs::path relative = run_dir_of(plan, key), run_dir = folder / relative;
  const TrialNote note = read_note(run_dir);
  const json metrics = read_json(run_dir / "metrics.json");
  StoredTrial trial;
  TrialResult& r = trial.result;
  std::tie(r.contestant, r.cave, r.seed) = key;
  r.run_dir = relative.string();
  const bool ended_well =
      !note.end.hung && note.end.signal == 0 && (note.end.exit_code == 0 || note.end.exit_code == 2);
  r.failed = !ended_well || !metrics.is_object();
  r.outcome = r.failed ? "failed" : text_of(metrics, "outcome");
  r.reason = r.failed ? failure(plan, run_dir, note.end) : text_of(metrics, "reason");
  for (const evaluation::MetricDefinition& m : evaluation::metric_definitions())
    r.figures.push_back(metrics.is_object() ? number_of(metrics, m.name) : kUnknown);
  if (!r.failed) r.ended = evaluation::read_ending(run_dir).sentence;
  const evaluation::RunRecord run = evaluation::read_run(run_dir);
  r.curve = curve_of(run, metrics.is_object() ? number_of(metrics, "coverage") : kUnknown);
  trial.binary_version = plan.contestants.at(r.contestant).binary_version;
  trial.mission_hash = mission_hash(plan, key);
  std::vector<std::string> problems;  // a truncated record has no timing: its figures are unknown
  trial.timing = {note.machine, note.end.wall_s, evaluation::read_wall_clock(run_dir, problems)};
  return trial;
}

}  // namespace karst::campaign
