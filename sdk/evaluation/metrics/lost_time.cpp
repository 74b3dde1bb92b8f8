#include "sdk/evaluation/metrics/lost_time.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace karst::evaluation {
namespace {

using core::Vec3;

// Of the limits: from there on a limit counts as what the speed is kept low for.
constexpr double kNearLimit = 0.7;
constexpr double kFullSpeed = 0.9;   // of v_max
constexpr double kFlat = 0.05;       // of v_max: the speed at a slowdown's slowest part varies by less
constexpr double kProminence = 0.1;  // of v_max: smaller changes of speed are no slowdown of their own
constexpr double kStands_mps = 0.1;
constexpr double kTurns_radps = 0.15;
/// A vehicle whose heading is farther off the direction of flight does not wait for its heading.
constexpr double kFacesAhead_rad = 0.6;
constexpr double kLongestStep_s = 1.0;  // a gap in the telemetry is left out

struct Limits {
  double speed_mps = 0, acceleration_mps2 = 0, heading_rate_radps = 0;
};

struct Sample {
  double t_s = 0, dt_s = 0, speed_mps = 0;
  double across_mps2 = 0, heading_rate_radps = 0;  // absolute values
  bool faces_ahead = false;
  bool looks_around = false;
};

double angle_between(double a, double b) { return std::remainder(b - a, 2 * std::numbers::pi); }

/// The moments of exploring, in stretches without a gap, by central differences.
std::vector<std::vector<Sample>> stretches(const RunRecord& run, double until_s) {
  const Table& table = run.telemetry;
  const auto* t_s = table.times();
  const auto *x = table.column("ref_x"), *y = table.column("ref_y"), *z = table.column("ref_z");
  const auto* heading = table.column("heading_rad");
  std::vector<std::vector<Sample>> out;
  if (!t_s || !x || !y || !z || !heading) return out;
  const auto at = [&](std::size_t i) { return Vec3((*x)[i], (*y)[i], (*z)[i]); };
  bool joined = false;
  for (std::size_t i = 1; i + 1 < t_s->size(); ++i) {
    const double t = (*t_s)[i], before_s = t - (*t_s)[i - 1], after_s = (*t_s)[i + 1] - t;
    const auto phase = std::find_if(run.phases.begin(), run.phases.end(), [&](const Phase& p) {
      return (p.traits().explores || p.is(core::Phase::look)) && t >= p.begin_s && t <= p.end_s;
    });
    const bool usable = before_s > 0 && after_s > 0 && before_s < kLongestStep_s &&
                        after_s < kLongestStep_s && at(i - 1).allFinite() && at(i).allFinite() &&
                        at(i + 1).allFinite() && std::isfinite((*heading)[i - 1]) &&
                        std::isfinite((*heading)[i]) && std::isfinite((*heading)[i + 1]);
    if (t > until_s || phase == run.phases.end() || !usable) {
      joined = false;
      continue;
    }
    if (!std::exchange(joined, true)) out.emplace_back();
    const Vec3 v0 = (at(i) - at(i - 1)) / before_s, v1 = (at(i + 1) - at(i)) / after_s;
    const Vec3 v = (at(i + 1) - at(i - 1)) / (before_s + after_s);
    const Vec3 a = (v1 - v0) / (0.5 * (before_s + after_s));
    Sample s;
    s.t_s = t;
    s.dt_s = 0.5 * (before_s + after_s);
    s.speed_mps = v.norm();
    if (s.speed_mps > kStands_mps) s.across_mps2 = (a - a.dot(v) / v.squaredNorm() * v).norm();
    s.heading_rate_radps =
        std::abs(angle_between((*heading)[i - 1], (*heading)[i + 1])) / (before_s + after_s);
    s.faces_ahead = v.head<2>().norm() > kStands_mps &&
                    std::abs(angle_between((*heading)[i], std::atan2(v.y(), v.x()))) < kFacesAhead_rad;
    s.looks_around = phase->is(core::Phase::look);
    out.back().push_back(s);
  }
  return out;
}

double lost_s(const Sample& s, const Limits& limits) {
  return s.dt_s * std::max(0.0, 1 - s.speed_mps / limits.speed_mps);
}

/// The samples at which the speed has a minimum, each lower by kProminence than the maxima beside it.
std::vector<std::size_t> minima(const std::vector<Sample>& samples, const Limits& limits) {
  const double prominence_mps = kProminence * limits.speed_mps;
  std::vector<std::size_t> out;
  std::size_t low = 0, high = 0;
  bool falls = true;  // from a maximum, or from the start
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double v = samples[i].speed_mps;
    if (falls) {
      if (v < samples[low].speed_mps) low = i;
      if (v > samples[low].speed_mps + prominence_mps) {
        out.push_back(low);
        falls = false;
        high = i;
      }
    } else {
      if (v > samples[high].speed_mps) high = i;
      if (v < samples[high].speed_mps - prominence_mps) {
        falls = true;
        low = i;
      }
    }
  }
  if (falls && !samples.empty()) out.push_back(low);
  return out;
}

SlowdownCause cause_of(const std::vector<Sample>& samples, std::size_t begin, std::size_t end,
                       const Limits& limits) {
  double across = 0, rate = 0, slowest_mps = limits.speed_mps;
  for (std::size_t i = begin; i < end; ++i) {
    across = std::max(across, samples[i].across_mps2 / limits.acceleration_mps2);
    if (samples[i].faces_ahead)
      rate = std::max(rate, samples[i].heading_rate_radps / limits.heading_rate_radps);
    slowest_mps = std::min(slowest_mps, samples[i].speed_mps);
  }
  if (slowest_mps < kStands_mps) return SlowdownCause::stop;
  if (std::max(across, rate) < kNearLimit) return SlowdownCause::other;
  return across >= rate ? SlowdownCause::bend : SlowdownCause::heading;
}

/// Each sample counts for the minimum whose slope or bottom it lies on; slopes meet at the highest speed.
void add(LostTime& out, const std::vector<Sample>& samples, const Limits& limits) {
  const std::vector<std::size_t> lows = minima(samples, limits);
  std::size_t begin = 0;
  for (std::size_t n = 0; n < lows.size(); ++n) {
    const auto first = samples.begin() + static_cast<std::ptrdiff_t>(lows[n]);
    const auto last =
        n + 1 < lows.size() ? samples.begin() + static_cast<std::ptrdiff_t>(lows[n + 1]) + 1 : samples.end();
    const auto faster = [](const Sample& a, const Sample& b) { return a.speed_mps < b.speed_mps; };
    const std::size_t end =
        n + 1 < lows.size()
            ? static_cast<std::size_t>(std::max_element(first, last, faster) - samples.begin())
            : samples.size();
    const double flat_mps = samples[lows[n]].speed_mps + kFlat * limits.speed_mps;
    std::size_t from = lows[n], to = lows[n] + 1;
    while (from > begin && samples[from - 1].speed_mps <= flat_mps) --from;
    while (to < end && samples[to].speed_mps <= flat_mps) ++to;
    // A limit that is only touched beside the flat part is what it slows down for as well.
    const SlowdownCause cause =
        cause_of(samples, from > begin ? from - 1 : from, std::min(to + 1, end), limits);
    for (std::size_t i = begin; i < end; ++i) {
      const Sample& s = samples[i];
      const double lost = lost_s(s, limits);
      out.total_s += lost;
      out.explored_s += s.dt_s;
      out.path_m += s.speed_mps * s.dt_s;
      if (s.looks_around) {
        out.look_around_s += lost;
      } else if (s.speed_mps < kStands_mps) {
        (s.heading_rate_radps > kTurns_radps ? out.turning_s : out.waiting_s) += lost;
      } else if (s.speed_mps > kFullSpeed * limits.speed_mps) {
        out.nearly_full_speed_s += lost;
      } else {
        (i < from ? out[cause].before_s : i < to ? out[cause].at_s : out[cause].after_s) += lost;
      }
    }
    begin = end;
  }
}

}  // namespace

std::optional<LostTime> lost_time(const RunRecord& run, double until_s) {
  const auto speed = run.number("motion.max_speed"), acceleration = run.number("motion.max_acceleration"),
             rate = run.number("motion.max_heading_rate");
  if (!speed || !acceleration || !rate || !(*speed > 0 && *acceleration > 0 && *rate > 0))
    return std::nullopt;
  const Limits limits{*speed, *acceleration, *rate};
  const auto all = stretches(run, until_s);
  if (all.empty()) return std::nullopt;
  LostTime out;
  out.max_speed_mps = limits.speed_mps;
  for (const std::vector<Sample>& samples : all) add(out, samples, limits);
  return out;
}

}  // namespace karst::evaluation
