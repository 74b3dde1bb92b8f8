// Flights to be shown side by side: their selection, compact enough for many of them in one page.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core_stack/common/error.h"
#include "sdk/campaign/report/report_parts.h"
#include "sdk/evaluation/metrics/flight_figures.h"
#include "sdk/evaluation/metrics/metric_definitions.h"
#include "sdk/evaluation/page/base64.h"
#include "sdk/evaluation/page/deflate.h"
#include "sdk/evaluation/report/report_scene.h"

namespace karst::campaign {
namespace {

namespace fs = std::filesystem;
using evaluation::CloudArrays;
using evaluation::RunRecord;
using nlohmann::ordered_json;

constexpr std::size_t kMaxPoints = 150000;  // of one flight: more would not be visible in half a window
constexpr std::size_t kTrackPoses = 1000;
constexpr double kTick_ms = 200;

bool has_recording(const TrialResult& t) {
  std::error_code no_matter;
  return !t.run_dir.empty() && fs::is_regular_file(fs::path(t.run_dir) / "map_growth.bin", no_matter);
}

/// The seed with the worst mean over contestants, and the median seed.
std::vector<std::int64_t> chosen_seeds(const CampaignResults& results, std::size_t cave, int metric) {
  std::map<std::int64_t, std::pair<double, int>> by_seed;  // sum and number
  for (const TrialResult& t : results.trials) {
    const double v = figure_of(t, metric, results.horizon_s);
    if (t.cave != cave || !std::isfinite(v) || !has_recording(t)) continue;
    by_seed[t.seed].first += v;
    ++by_seed[t.seed].second;
  }
  const auto& definition = evaluation::metric_definitions()[static_cast<std::size_t>(metric)];
  const double sign = definition.better == evaluation::Better::less ? -1 : 1;
  // Prefer seeds that all contestants flew: a flight without its partner cannot be compared.
  int most = 0;
  for (const auto& [seed, sum] : by_seed) most = std::max(most, sum.second);
  std::vector<std::pair<double, std::int64_t>> order;
  for (const auto& [seed, sum] : by_seed)
    if (sum.second == most) order.emplace_back(sign * sum.first / sum.second, seed);
  std::sort(order.begin(), order.end());
  if (order.empty()) return {};
  std::vector<std::int64_t> seeds = {order[order.size() / 2].second};
  if (order.size() > 1) seeds.push_back(order.front().second);
  return seeds;
}

/// The parts of a run that are drawn, with times from take-off.
RunRecord recording_of(const TrialResult& trial) {
  RunRecord run = evaluation::read_run(trial.run_dir);
  const double begin_s = evaluation::flight_begin_s(run);
  const auto begin_ms = static_cast<std::int32_t>(std::lround(1000 * begin_s));
  for (auto* poses : {&run.estimate, &run.truth})
    for (evaluation::StampedPose& p : *poses) p.t_s -= begin_s;
  for (evaluation::OccupiedSpan& s : run.growth) {
    s.from_ms -= begin_ms;
    if (s.until_ms != evaluation::OccupiedSpan::kNever) s.until_ms -= begin_ms;
  }
  for (evaluation::Phase& p : run.phases) {
    p.begin_s -= begin_s;
    p.end_s -= begin_s;
  }
  run.events.clear();
  run.truth_events.clear();
  return run;
}

/// Each axis as differences to the previous cell, then times, then normals in steps of 1/16: this form
/// compresses well with deflate.
ordered_json packed(const CloudArrays& cloud) {
  const std::size_t n = cloud.from.size();
  std::vector<std::byte> bytes;
  const auto append = [&bytes](const auto& values) {
    const auto more = std::as_bytes(std::span(values));
    bytes.insert(bytes.end(), more.begin(), more.end());
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<std::int16_t> steps;
    for (std::size_t i = 0; i < n; ++i)
      steps.push_back(static_cast<std::int16_t>(cloud.cells[3 * i + axis] -
                                                (i > 0 ? cloud.cells[3 * (i - 1) + axis] : 0)));
    append(steps);
  }
  append(cloud.from);
  append(cloud.until);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<std::int8_t> coarse;
    for (std::size_t i = 0; i < n; ++i)
      coarse.push_back(static_cast<std::int8_t>(
          8 * std::clamp(std::lround(cloud.normals[3 * i + axis] / 8.0), -15l, 15l)));
    append(coarse);
  }
  return {{"count", n},
          {"cell_m", cloud.cell_m},
          {"origin", cloud.origin},
          {"tick_s", cloud.tick_s},
          {"packed", evaluation::base64(evaluation::deflated(bytes))}};
}

ordered_json scene(std::size_t trial, const RunRecord& run, const CloudArrays& cloud) {
  ordered_json phases = ordered_json::array();
  for (const evaluation::Phase& p : run.phases)
    phases.push_back({p.name, number_or_null(p.begin_s), number_or_null(p.end_s)});
  const double end_s = run.phases.empty() ? run.last_time_s() : run.phases.back().end_s;
  return {{"trial", trial},
          {"end_s", number_or_null(end_s)},
          {"phases", std::move(phases)},
          {"cloud", cloud.cells.empty() ? ordered_json(nullptr) : packed(cloud)},
          {"track", evaluation::scene_track(run.estimate.empty() ? run.truth : run.estimate, kTrackPoses)}};
}

/// All flights of one cave, with maps of one cell size, so that no flight is shown in finer detail.
void add_scenes(ordered_json& scenes, const CampaignResults& results, const std::vector<std::size_t>& trials,
                std::size_t max_points, std::vector<std::string>& notes) {
  std::map<std::size_t, std::pair<RunRecord, CloudArrays>> flights;
  double cell_m = 0;
  const auto cloud_of = [&](const RunRecord& run, double min_cell_m) {
    const double length_ms = 1000 * (run.phases.empty() ? run.last_time_s() : run.phases.back().end_s);
    std::vector<std::string> far;
    return cloud_arrays(run, max_points, min_cell_m, std::max(kTick_ms, length_ms / 65534), far);
  };
  for (const std::size_t i : trials) try {
      RunRecord run = recording_of(results.trials[i]);
      CloudArrays cloud = cloud_of(run, 0);
      cell_m = std::max(cell_m, cloud.cell_m);
      flights.emplace(i, std::pair(std::move(run), std::move(cloud)));
    } catch (const core::InputError& e) {
      notes.push_back(std::string("not replayed: ") + e.what());
    }
  for (auto& [i, flight] : flights) {
    auto& [run, cloud] = flight;
    if (cloud.cell_m < 0.999 * cell_m) cloud = cloud_of(run, cell_m);
    scenes.push_back(scene(i, run, cloud));
  }
}

}  // namespace

ordered_json report_replays(const CampaignResults& results, int metric, std::size_t max_points,
                            std::vector<std::string>& notes) {
  ordered_json seeds = ordered_json::array(), scenes = ordered_json::array();
  std::vector<std::vector<std::size_t>> by_cave;
  std::size_t count = 0;
  for (std::size_t cave = 0; cave < results.caves.size(); ++cave) {
    const std::vector<std::int64_t> chosen =
        max_points > 0 ? chosen_seeds(results, cave, metric) : std::vector<std::int64_t>();
    seeds.push_back(chosen);  // the median seed, then the worst
    by_cave.emplace_back();
    for (std::size_t i = 0; i < results.trials.size(); ++i) {
      const TrialResult& t = results.trials[i];
      const bool wanted = std::find(chosen.begin(), chosen.end(), t.seed) != chosen.end();
      if (t.cave == cave && wanted && has_recording(t)) by_cave.back().push_back(i);
    }
    count += by_cave.back().size();
  }
  if (count > 0)
    for (const auto& trials : by_cave)
      add_scenes(scenes, results, trials, std::min(kMaxPoints, max_points / count), notes);
  return {{"seeds", std::move(seeds)}, {"scenes", std::move(scenes)}};
}

}  // namespace karst::campaign
