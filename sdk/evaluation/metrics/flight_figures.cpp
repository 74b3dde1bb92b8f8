#include "sdk/evaluation/metrics/flight_figures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sdk/evaluation/accuracy/trajectory_error.h"
#include "sdk/evaluation/metrics/depth.h"

namespace karst::evaluation {
namespace {

using core::MissionOutcome;
using core::Vec3;
namespace event = core::event;

constexpr double kStandingSpeed_mps = 0.2;
constexpr double kProgress_m = 0.5;

bool within(const RunRecord& run, double t_s, bool core::PhaseTraits::*trait) {
  return std::any_of(run.phases.begin(), run.phases.end(),
                     [&](const Phase& p) { return p.traits().*trait && t_s >= p.begin_s && t_s <= p.end_s; });
}

double flight_end_s(const RunRecord& run) {
  return run.phases.empty() ? run.last_time_s() : run.phases.back().end_s;
}

/// Root of the mean of the squares; none without samples.
class RootMeanSquare {
 public:
  void add(double v) {
    sum_ += v * v;
    ++count_;
  }
  std::optional<double> value() const {
    if (count_ == 0) return std::nullopt;
    return std::sqrt(sum_ / static_cast<double>(count_));
  }

 private:
  double sum_ = 0;
  std::size_t count_ = 0;
};

/// Statistics of the exploration phase.
struct Exploring {
  std::optional<double> standing_share, mean_speed_mps;
};

Exploring exploring(const RunRecord& run) {
  std::vector<double> t_s, speed;
  if (run.truth_table.times() && run.truth_table.column("speed_mps")) {
    t_s = *run.truth_table.times();
    speed = *run.truth_table.column("speed_mps");
  } else if (run.telemetry.times() && run.telemetry.column("vx") && run.telemetry.column("vy") &&
             run.telemetry.column("vz")) {
    t_s = *run.telemetry.times();
    for (std::size_t i = 0; i < t_s.size(); ++i)
      speed.push_back(Vec3((*run.telemetry.column("vx"))[i], (*run.telemetry.column("vy"))[i],
                           (*run.telemetry.column("vz"))[i])
                          .norm());
  }
  double exploring = 0, standing = 0, length_m = 0;
  for (std::size_t i = 1; i < t_s.size(); ++i) {
    if (!within(run, t_s[i - 1], &core::PhaseTraits::explores) ||
        !within(run, t_s[i], &core::PhaseTraits::explores))
      continue;
    exploring += t_s[i] - t_s[i - 1];
    length_m += speed[i] * (t_s[i] - t_s[i - 1]);
    if (speed[i] < kStandingSpeed_mps) standing += t_s[i] - t_s[i - 1];
  }
  if (exploring <= 0) return {};
  return {standing / exploring, length_m / exploring};
}

std::optional<double> longest_stall_s(const RunRecord& run, const std::vector<StampedPose>& poses) {
  std::optional<double> longest_s;
  const StampedPose* landmark = nullptr;
  for (const StampedPose& p : poses) {
    if (!within(run, p.t_s, &core::PhaseTraits::flies_by_map)) continue;
    if (!landmark || (p.T_world_body.position - landmark->T_world_body.position).norm() > kProgress_m)
      landmark = &p;
    longest_s = std::max(longest_s.value_or(0), p.t_s - landmark->t_s);
  }
  return longest_s;
}

std::optional<double> min_clearance_m(const RunRecord& run) {
  const auto* t_s = run.truth_table.times();
  const auto* clearance = run.truth_table.column("clearance_m");
  if (!t_s || !clearance) return std::nullopt;
  std::optional<double> least;
  for (std::size_t i = 0; i < t_s->size(); ++i) {
    const double c = (*clearance)[i];
    if (std::isfinite(c) && within(run, (*t_s)[i], &core::PhaseTraits::above_ground))
      least = std::min(least.value_or(c), c);
  }
  return least;
}

/// Contacts recorded by the simulator; without its record, the one that ended the flight, if any.
std::optional<std::int64_t> contacts(const RunRecord& run) {
  const auto end = run.last<event::Outcome>();
  const bool nobody_watched = !end || end->outcome == MissionOutcome::replayed;
  if (run.truth_events.empty() && nobody_watched) return std::nullopt;
  std::int64_t count = 0;
  for (const auto& e : run.truth_events)
    count += event_text(e, "event") == core::name_of(MissionOutcome::contact);
  const bool ended_so = end && end->outcome == MissionOutcome::contact;
  return std::max<std::int64_t>(count, ended_so ? 1 : 0);
}

/// Tracking error: the estimated position against the reference, over the flight. The error of the estimate
/// itself is drift, which no controller can reduce.
std::optional<double> tracking_rms_m(const RunRecord& run) {
  const auto* t_s = run.telemetry.times();
  std::array<const std::vector<double>*, 6> c{};
  for (std::size_t i = 0; i < c.size(); ++i)
    c[i] = run.telemetry.column(std::array{"x", "y", "z", "ref_x", "ref_y", "ref_z"}[i]);
  if (!t_s || std::find(c.begin(), c.end(), nullptr) != c.end()) return std::nullopt;
  RootMeanSquare rms;
  for (std::size_t i = 0; i < t_s->size(); ++i) {
    const Vec3 off((*c[0])[i] - (*c[3])[i], (*c[1])[i] - (*c[4])[i], (*c[2])[i] - (*c[5])[i]);
    if (off.allFinite() && within(run, (*t_s)[i], &core::PhaseTraits::airborne)) rms.add(off.norm());
  }
  return rms.value();
}

/// The energy used during the flight: the drop of the battery's fraction times the capacity in the settings.
std::optional<double> energy_wh(const RunRecord& run, double begin_s, double end_s) {
  const auto* t_s = run.telemetry.times();
  const auto* fraction = run.telemetry.column("battery_fraction");
  const auto hover_w = run.number("simulator.hover_power"), minutes = run.number("simulator.battery_minutes");
  if (!t_s || !fraction || !hover_w || !minutes) return std::nullopt;
  std::optional<double> first, last;
  for (std::size_t i = 0; i < t_s->size(); ++i)
    if ((*t_s)[i] >= begin_s && (*t_s)[i] <= end_s && std::isfinite((*fraction)[i])) {
      if (!first) first = (*fraction)[i];
      last = (*fraction)[i];
    }
  if (!first) return std::nullopt;
  return (*first - *last) * *hover_w * *minutes / 60;
}

void farthest(const std::vector<StampedPose>& poses, double begin_s, double end_s, FlightFigures& f) {
  std::vector<Vec3> positions;
  for (const StampedPose& p : poses)
    if (p.t_s >= begin_s && p.t_s <= end_s) positions.push_back(p.T_world_body.position);
  if (positions.empty()) return;
  f.depth_m = depth_along_path(positions);
  f.vertical_reach_m = vertical_reach(positions);
}

void estimate_errors(const RunRecord& run, double begin_s, double end_s, FlightFigures& f) {
  const std::vector<PosePair> pairs = paired_with_truth(run.truth, run.estimate, begin_s, end_s);
  f.heading_error_rad = heading_rms_rad(pairs);
  const std::optional<double> error_m = end_error_m(pairs);
  if (error_m && f.path_length_m && *f.path_length_m > 0)
    f.drift_percent = 100.0 * *error_m / *f.path_length_m;
}

}  // namespace

std::optional<double> last_finite(const std::vector<double>* column) {
  if (!column) return std::nullopt;
  const auto last = std::find_if(column->rbegin(), column->rend(), [](double v) { return std::isfinite(v); });
  if (last == column->rend()) return std::nullopt;
  return *last;
}

std::optional<double> landed_off_m(const RunRecord& run) {
  if (run.truth.empty()) return std::nullopt;
  return (run.truth.back().T_world_body.position - run.truth.front().T_world_body.position).head<2>().norm();
}

bool explored_to_its_end(const RunRecord& run) {
  double explored_until_s = -1;
  for (const Phase& p : run.phases)
    if (p.traits().explores) explored_until_s = p.end_s;
  if (explored_until_s < 0) return false;
  return std::none_of(run.events.begin(), run.events.end(), [&](const nlohmann::json& e) {
    const auto safety = event::as<event::Safety>(e);
    return safety &&
           (safety->action == core::SafetyAction::home || safety->action == core::SafetyAction::land) &&
           e["t"].get<double>() <= explored_until_s;
  });
}

bool completed(const RunRecord& run, std::optional<double> landing_error_m) {
  const auto end = run.last<event::Outcome>();
  return end && end->outcome == MissionOutcome::landed && !(landing_error_m.value_or(0) > kAtStart_m) &&
         explored_to_its_end(run);
}

double flight_begin_s(const RunRecord& run) {
  for (const Phase& p : run.phases)
    if (!p.is(core::Phase::standby)) return p.begin_s;
  const auto* t_s = run.telemetry.times();
  return t_s && !t_s->empty() ? t_s->front() : 0.0;
}

FlightFigures flight_figures(const RunRecord& run) {
  FlightFigures f;
  const double begin_s = flight_begin_s(run), end_s = flight_end_s(run);
  f.contacts = contacts(run);
  if (end_s > begin_s) f.flight_time_s = end_s - begin_s;
  for (const Phase& p : run.phases)
    if (p.traits().explores) f.exploration_time_s = f.exploration_time_s.value_or(0) + p.end_s - p.begin_s;
  const auto& poses = run.truth.empty() ? run.estimate : run.truth;
  if (!poses.empty()) f.path_length_m = path_length_m(poses, begin_s, end_s);
  if (f.path_length_m && f.flight_time_s) f.mean_speed_mps = *f.path_length_m / *f.flight_time_s;
  const Exploring spent = exploring(run);
  f.standing_share = spent.standing_share;
  f.exploring_speed_mps = spent.mean_speed_mps;
  f.longest_stall_s = longest_stall_s(run, poses);
  f.min_clearance_m = min_clearance_m(run);
  f.landing_error_m = landed_off_m(run);
  f.battery_left = last_finite(run.telemetry.column("battery_fraction"));
  f.energy_wh = energy_wh(run, begin_s, end_s);
  farthest(poses, begin_s, end_s, f);
  estimate_errors(run, begin_s, end_s, f);
  f.tracking_rms_m = tracking_rms_m(run);
  return f;
}

}  // namespace karst::evaluation
