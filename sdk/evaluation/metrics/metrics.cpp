#include "sdk/evaluation/metrics/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core_stack/common/error.h"
#include "core_stack/common/json_text.h"
#include "core_stack/common/rounded.h"
#include "core_stack/mapping/octomap/octomap_io.h"
#include "sdk/evaluation/accuracy/map_error.h"
#include "sdk/evaluation/metrics/coverage_curve.h"
#include "sdk/evaluation/metrics/earlier_map.h"
#include "sdk/evaluation/metrics/flight_figures.h"
#include "sdk/evaluation/metrics/object_figures.h"
#include "sdk/evaluation/metrics/replay_figures.h"
#include "sdk/evaluation/metrics/unsurveyed.h"
#include "sdk/evaluation/record/whole_file.h"

namespace karst::evaluation {
namespace {

using core::Cell;
using core::CellKey;
using core::Vec3;
using nlohmann::json;
using nlohmann::ordered_json;
namespace event = core::event;

/// Null for unknown values; otherwise rounded, so that the number's text is short and reproducible.
ordered_json value(std::optional<double> v) {
  if (!v || !std::isfinite(*v)) return nullptr;
  return core::to_millionths(*v);
}

std::string first_setting(const RunRecord& run, std::initializer_list<const char*> keys) {
  for (const char* key : keys)
    if (const std::string text = run.setting(key); !text.empty()) return text;
  return "";
}

ordered_json text_or_null(const std::string& text) {
  return text.empty() ? ordered_json(nullptr) : ordered_json(text);
}

std::size_t count_goals(const RunRecord& run, event::GoalState state) {
  return static_cast<std::size_t>(std::count_if(run.events.begin(), run.events.end(), [&](const json& e) {
    const auto goal = event::as<event::Goal>(e);
    return goal && goal->state == state;
  }));
}

std::size_t count_events(const RunRecord& run, const char* kind) {
  return static_cast<std::size_t>(std::count_if(run.events.begin(), run.events.end(),
                                                [&](const json& e) { return event::is_kind(e, kind); }));
}

struct Volume {
  std::optional<double> explored_m3, coverage;
};

/// Volume of the final map. A truncated run has no map: then the last volume in the telemetry is used, as if
/// all of it lay in R, which overestimates by the part outside R.
Volume volume_of(const RunRecord& run, const core::VoxelMap* map, const Truth& truth) {
  Volume volume;
  if (!map) {
    volume.explored_m3 = last_finite(run.telemetry.column("explored_m3"));
    if (volume.explored_m3 && truth.reachable_volume_m3 && *truth.reachable_volume_m3 > 0)
      volume.coverage = std::min(1.0, *volume.explored_m3 / *truth.reachable_volume_m3);
    return volume;
  }
  volume.explored_m3 = map->free_volume_m3();
  if (!truth.is_reachable || !truth.reachable_volume_m3 || *truth.reachable_volume_m3 <= 0) return volume;
  std::size_t inside = 0;
  map->for_each_known([&](const CellKey& k, Cell c, float) {
    inside += c == Cell::free && truth.is_reachable(map->center_of(k));
  });
  const double cell_m3 = std::pow(map->resolution_m(), 3);
  volume.coverage = static_cast<double>(inside) * cell_m3 / *truth.reachable_volume_m3;
  return volume;
}

/// Fraction of the cells that satisfy `holds` themselves or share a face with a cell that does.
template <class Holds>
double fraction_near(const std::vector<CellKey>& cells, const Holds& holds) {
  constexpr std::array<CellKey, 7> kNear{
      {{}, {-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};
  const auto count = std::count_if(cells.begin(), cells.end(), [&](const CellKey& k) {
    return std::any_of(kNear.begin(), kNear.end(), [&](const CellKey& d) { return holds(k + d); });
  });
  return static_cast<double>(count) / static_cast<double>(cells.size());
}

/// Fraction of the surface cells that are occupied in the map, or share a face with an occupied cell: scans
/// are off by centimetres, and cells that the rock only just enters are seldom hit.
std::optional<double> surface_seen(const RunRecord& run, const core::VoxelMap* map, const Truth& truth) {
  if (truth.surface.empty()) return std::nullopt;
  std::set<CellKey> grown;
  if (!map)
    for (const OccupiedSpan& s : run.growth)
      if (s.until_ms == OccupiedSpan::kNever) grown.insert(s.key);
  const auto occupied = [&](const CellKey& k) {
    return map ? map->at(k) == Cell::occupied : grown.count(k) > 0;
  };
  return fraction_near(truth.surface, occupied);
}

/// The same for the surface that the colour camera truly imaged. Null without such a camera.
std::optional<double> surface_imaged(const Truth& truth) {
  if (truth.surface.empty() || !truth.imaged_rock) return std::nullopt;
  const std::vector<CellKey>& imaged = *truth.imaged_rock;
  return fraction_near(truth.surface,
                       [&](const CellKey& k) { return std::binary_search(imaged.begin(), imaged.end(), k); });
}

std::optional<double> restricted(const std::vector<CoveragePoint>& curve, double fraction,
                                 std::optional<double> horizon) {
  if (!horizon || curve.empty() || std::isnan(curve.back().coverage)) return std::nullopt;
  return std::min(time_of_coverage(curve, fraction).value_or(*horizon), *horizon);
}

ErrorStatistics map_error(const RunRecord& run, const core::VoxelMap* map, const Truth& truth) {
  if (!truth.distance_to_rock) return {};
  std::vector<Vec3> centres;
  const double cell = run.map_resolution_m();
  if (map) {
    centres = occupied_centres(*map);
  } else {
    for (const OccupiedSpan& s : run.growth)
      if (s.until_ms == OccupiedSpan::kNever)
        centres.push_back(cell * (Vec3(s.key.x, s.key.y, s.key.z) + Vec3::Constant(0.5)));
  }
  return statistics_of(map_errors(centres, truth.distance_to_rock));
}

/// Only the keys of a region that limits something are recorded.
bool flies_in_region(const RunRecord& run) {
  return std::any_of(run.settings.begin(), run.settings.end(),
                     [](const Setting& s) { return s.key.starts_with("region."); });
}

/// Of the explored volume, what the earlier map lacks.
std::optional<double> added_m3(std::optional<double> explored_m3, std::optional<double> earlier_m3) {
  if (!explored_m3 || !earlier_m3) return std::nullopt;
  return std::max(0.0, *explored_m3 - *earlier_m3);
}

}  // namespace

ordered_json evaluate(const RunRecord& run, const core::VoxelMap* map, const Truth& truth) {
  const auto end = run.last<event::Outcome>();
  const core::MissionOutcome outcome = end ? end->outcome : core::MissionOutcome::aborted;
  const std::string cave = first_setting(run, {"cave.file", "cave"});
  const std::string seed = first_setting(run, {"seed", "mission.seed"});
  const Volume volume = volume_of(run, map, truth);
  const ErrorStatistics error = map_error(run, map, truth);
  const FlightFigures f = flight_figures(run);
  const std::vector<CoveragePoint> curve = coverage_curve(run, volume.coverage);
  const std::optional<double> horizon = horizon_s(run);
  const bool has_events = !run.events.empty();

  ordered_json m;
  m["schema"] = "karst.metrics/1";
  m["policy"] = text_or_null(first_setting(run, {"policy.name", "policy"}));
  m["cave"] = text_or_null(std::filesystem::path(cave).stem().string());
  m["seed"] = nullptr;
  if (!seed.empty()) {
    const json number = core::json_of(seed);
    if (number.is_number_integer()) m["seed"] = number;
  }
  m["outcome"] = core::name_of(outcome);
  m["reason"] = end ? end->reason : "the record ends without an outcome";
  m["completed"] =
      has_events ? ordered_json(completed(run, f.landing_error_m) ? 1 : 0) : ordered_json(nullptr);
  m["contacts"] = f.contacts ? ordered_json(*f.contacts) : ordered_json(nullptr);
  m["flight_time_s"] = value(f.flight_time_s);
  m["exploration_time_s"] = value(f.exploration_time_s);
  m["path_length_m"] = value(f.path_length_m);
  m["mean_speed_mps"] = value(f.mean_speed_mps);
  m["exploring_speed_mps"] = value(f.exploring_speed_mps);
  m["standing_share"] = value(f.standing_share);
  m["longest_stall_s"] = value(f.longest_stall_s);
  m["energy_wh"] = value(f.energy_wh);
  m["explored_volume_m3"] = value(volume.explored_m3);
  m["reachable_volume_m3"] = value(truth.reachable_volume_m3);
  m["coverage"] = value(volume.coverage);
  if (flies_in_region(run)) m["coverage_of"] = "region";
  m["horizon_s"] = value(horizon);
  m["coverage_auc"] = value(horizon ? mean_coverage(curve, *horizon) : std::nullopt);
  for (const int percent : {25, 50, 75})
    m["coverage_at_" + std::to_string(percent)] =
        value(horizon ? coverage_at(curve, *horizon * percent / 100) : std::nullopt);
  m["t50_s"] = value(time_of_coverage(curve, 0.50));
  m["t90_s"] = value(time_of_coverage(curve, 0.90));
  m["t95_s"] = value(time_of_coverage(curve, 0.95));
  m["restricted_t50_s"] = value(restricted(curve, 0.50, horizon));
  m["restricted_t90_s"] = value(restricted(curve, 0.90, horizon));
  m["restricted_t95_s"] = value(restricted(curve, 0.95, horizon));
  m["surface_seen"] = value(surface_seen(run, map, truth));
  m["surface_imaged"] = value(surface_imaged(truth));
  m["depth_m"] = value(f.depth_m);
  m["vertical_reach_m"] = value(f.vertical_reach_m);
  m["min_clearance_m"] = value(f.min_clearance_m);
  m["landing_error_m"] = value(outcome == core::MissionOutcome::landed ? f.landing_error_m : std::nullopt);
  m["battery_left"] = value(f.battery_left);
  m["map_error_mean_m"] = value(error.count ? std::optional(error.mean) : std::nullopt);
  m["map_error_std_m"] = value(error.count ? std::optional(error.std) : std::nullopt);
  m["drift_percent"] = value(f.drift_percent);
  m["heading_error_rad"] = value(f.heading_error_rad);
  m["tracking_rms_m"] = value(f.tracking_rms_m);
  m["goals_accepted"] =
      has_events ? ordered_json(count_goals(run, event::GoalState::accepted)) : ordered_json(nullptr);
  m["goals_rejected"] =
      has_events ? ordered_json(count_goals(run, event::GoalState::rejected)) : ordered_json(nullptr);
  m["overruns"] = has_events ? ordered_json(count_events(run, event::Overrun::kKind)) : ordered_json(nullptr);
  set_figures(m, object_figures(run));
  for (const char* key :
       {"data_at_base_share", "robots_landed", "robots_connected", "exploration_time_1_s",
        "exploration_time_2_s", "exploration_time_3_s", "exploration_time_4_s", "exploration_time_5_s"})
    m[key] = nullptr;  // of a team: sdk/flight/team_metrics.h
  if (const auto beyond = unsurveyed_figures(run)) {
    m["unsurveyed_volume_m3"] = value(beyond->volume_m3);
    m["time_to_unsurveyed_50_s"] = value(beyond->time_to_50_s);
  }
  if (const auto earlier = earlier_map_figures(run)) {
    m["earlier_map_found"] = earlier->found ? 1 : 0;
    m["earlier_volume_m3"] = value(earlier->earlier_m3);
    m["added_volume_m3"] = value(added_m3(volume.explored_m3, earlier->earlier_m3));
  }
  if (const auto replayed = replay_figures(run)) {
    m["recording"] = replayed->recording;
    m["scans"] = replayed->scans;
    m["scans_lost"] = replayed->lost;
    m["loops_closed"] = replayed->closures;
    m["loop_correction_m"] = value(replayed->correction_m);
  }
  m["volume_per_wh_m3"] = value(volume.explored_m3 && f.energy_wh && *f.energy_wh > 0
                                    ? std::optional(*volume.explored_m3 / *f.energy_wh)
                                    : std::nullopt);
  return m;
}

ordered_json evaluate_run(const std::filesystem::path& run_dir, const Truth& truth,
                          std::vector<std::string>* problems) {
  RunRecord run = read_run(run_dir);
  std::optional<core::VoxelMap> map;
  try {
    if (std::filesystem::is_directory(run_dir / "map.bt"))
      throw core::InputError("map.bt", "", "is a directory, not a file");
    if (std::filesystem::exists(run_dir / "map.bt")) map = core::read_octomap((run_dir / "map.bt").string());
  } catch (const core::InputError& e) {
    run.problems.push_back(e.what());
  }
  if (problems) *problems = run.problems;
  return evaluate(run, map ? &*map : nullptr, truth);
}

void write_metrics(const std::filesystem::path& run_dir, const ordered_json& metrics) {
  write_whole_file(run_dir / "metrics.json", core::json_text(metrics, 2) + "\n");
}

}  // namespace karst::evaluation
