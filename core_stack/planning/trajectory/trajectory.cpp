#include "core_stack/planning/trajectory/trajectory.h"

#include <algorithm>
#include <cmath>

#include "core_stack/common/install_location.h"
#include "core_stack/planning/path/path.h"
#include "core_stack/planning/trajectory/heading.h"

namespace karst::core {
namespace {

constexpr TimeNs kPeriod = 100 * kMillisecond;
/// Spacing of the path's nodes; with the period it bounds the rounding of a bend (to a quarter of it).
constexpr double kMaxSpacing_m = 0.1;
/// Maximal duration: longer than any battery lasts, and 72,000 samples.
constexpr double kLongest_s = 7200;

/// Points at equal distances along the polyline; both ends are kept.
std::vector<Vec3> evenly_spaced(const std::vector<Vec3>& points, double max_spacing_m) {
  std::vector<double> at{0};
  for (std::size_t i = 1; i < points.size(); ++i)
    at.push_back(at.back() + (points[i] - points[i - 1]).norm());
  const double length = at.back();
  const auto n = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(length / max_spacing_m - 1e-9)));
  std::vector<Vec3> out{points.front()};
  std::size_t i = 1;
  for (std::size_t k = 1; k < n; ++k) {
    const double s = length * static_cast<double>(k) / static_cast<double>(n);
    while (at[i] < s) ++i;
    out.push_back(points[i - 1] + (points[i] - points[i - 1]) * ((s - at[i - 1]) / (at[i] - at[i - 1])));
  }
  out.push_back(points.back());
  return out;
}

/// Angle by which the path turns at each node.
std::vector<double> turns(const std::vector<Vec3>& nodes) {
  std::vector<double> out(nodes.size(), 0.0);
  for (std::size_t i = 1; i + 1 < nodes.size(); ++i) {
    const Vec3 a = nodes[i] - nodes[i - 1], b = nodes[i + 1] - nodes[i];
    out[i] = std::atan2(a.cross(b).norm(), a.dot(b));
  }
  return out;
}

/// At v_max the turn requires a_n = v_max^2 turn / spacing, which falls with the square of the speed. Never
/// below v_min.
double bend_speed_mps(double turn_rad, double spacing_m, const MotionLimits& limits) {
  const double v = limits.max_speed_mps, a_n = v * v * turn_rad / spacing_m;
  const double slow =
      a_n > limits.max_acceleration_mps2 ? v * std::sqrt(limits.max_acceleration_mps2 / a_n) : v;
  return std::max(slow, std::min(limits.min_speed_mps, limits.max_speed_mps));
}

/// What the acceleration across the path leaves along it: both together are within the limit.
double left_along_mps2(double v_mps, double turn_rad, double spacing_m, const MotionLimits& limits) {
  const double a = limits.max_acceleration_mps2, a_n = std::min(a, v_mps * v_mps * turn_rad / spacing_m);
  return std::sqrt(a * a - a_n * a_n);
}

/// Lowers `v` so that the vehicle can slow down for each node's speed.
void slow_down_in_time(std::vector<double>& v, const std::vector<double>& turn, double spacing_m,
                       const MotionLimits& limits) {
  for (std::size_t i = v.size() - 1; i-- > 0;)
    v[i] =
        std::min(v[i], std::sqrt(v[i + 1] * v[i + 1] +
                                 2 * left_along_mps2(v[i + 1], turn[i + 1], spacing_m, limits) * spacing_m));
}

struct Speeds {
  std::vector<double> mps;
  std::vector<SpeedLimit> limited_by;
};

/// Speed at each node: limited in bends, and by the acceleration between nodes. `headings` limit it further
/// where they turn with the path.
Speeds speeds(const std::vector<Vec3>& nodes, double spacing_m, double start_speed_mps,
              const MotionLimits& limits, const std::vector<double>& headings, const SlowPlaces& slow) {
  const double a_max = limits.max_acceleration_mps2;
  const std::vector<double> turn = turns(nodes);
  Speeds out{std::vector<double>(nodes.size(), limits.max_speed_mps),
             std::vector<SpeedLimit>(nodes.size(), SpeedLimit::allowed)};
  std::vector<double>& v = out.mps;
  const auto lower = [&](std::size_t i, double speed_mps, SpeedLimit why) {
    if (speed_mps >= v[i]) return;
    v[i] = speed_mps;
    out.limited_by[i] = why;
  };
  for (std::size_t i = 0; i < v.size(); ++i) {
    lower(i, bend_speed_mps(turn[i], spacing_m, limits), SpeedLimit::bend);
    if (i + 1 < v.size()) {
      const double heading_turn = std::abs(wrap_angle(headings[i + 1] - headings[i]));
      if (heading_turn > 1e-9)
        lower(i, limits.max_heading_rate_radps * spacing_m / heading_turn, SpeedLimit::heading);
    }
    const auto is_near = [&](const Vec3& p) {
      return (p - nodes[i]).squaredNorm() < slow.radius_m * slow.radius_m;
    };
    if (v[i] > slow.speed_mps && std::any_of(slow.places.begin(), slow.places.end(), is_near))
      lower(i, slow.speed_mps, SpeedLimit::narrow);
    const double to_end_m = spacing_m * static_cast<double>(v.size() - 1 - i);
    lower(i, slow.trusted.sight_at_mps(to_end_m), SpeedLimit::sight);
    lower(i, slow.trusted.room_at_mps(to_end_m), SpeedLimit::room);
    v[i] = std::max(v[i], std::min(limits.min_speed_mps, limits.max_speed_mps));
  }
  // A vehicle that arrives too fast for a bend brakes at the limit. So does a fast one for what is allowed
  // now; up to 2 m/s, where no trusted speeds are set, the tracker takes that small step.
  const double greatest_mps = slow.trusted.sight_mps.empty() ? limits.max_speed_mps : start_speed_mps;
  const double v0 = std::clamp(start_speed_mps, 0.0, std::max(0.0, greatest_mps));
  for (std::size_t i = 0; i < v.size(); ++i)
    v[i] = std::max(v[i], std::sqrt(std::max(0.0, v0 * v0 - 2 * a_max * spacing_m * static_cast<double>(i))));
  v.front() = v0;
  v.back() = 0;
  out.limited_by.back() = SpeedLimit::end;
  for (std::size_t i = v.size() - 1; i-- > 0;)
    lower(i, std::sqrt(v[i + 1] * v[i + 1] + 2 * a_max * spacing_m), out.limited_by[i + 1]);
  for (std::size_t i = 1; i < v.size(); ++i)
    lower(i, std::sqrt(v[i - 1] * v[i - 1] + 2 * a_max * spacing_m), SpeedLimit::speeding_up);
  if (v.size() > 1) out.limited_by.front() = out.limited_by[1];
  return out;
}

/// Point at node coordinate `u`: the quadratic B-spline of the nodes, which begins and ends at the end nodes
/// and spreads the turn at a node over the stretch around it.
Vec3 point_at(const std::vector<Vec3>& nodes, double u) {
  const auto last = static_cast<double>(nodes.size() - 1);
  u = std::clamp(u, 0.0, last);
  const double nearest = std::round(u);
  const auto i = static_cast<std::size_t>(nearest);
  if (nearest <= 0 || nearest >= last) {
    const Vec3& inner = nodes[nearest <= 0 ? std::min<std::size_t>(1, nodes.size() - 1) : i - 1];
    return nodes[i] + (inner - nodes[i]) * std::abs(u - nearest);
  }
  const double t = u - nearest;
  return 0.5 * (0.5 - t) * (0.5 - t) * nodes[i - 1] + (0.75 - t * t) * nodes[i] +
         0.5 * (0.5 + t) * (0.5 + t) * nodes[i + 1];
}

/// Time at each node, with constant acceleration between nodes.
std::vector<double> times(const std::vector<double>& v, double spacing_m) {
  std::vector<double> t{0};
  for (std::size_t i = 1; i < v.size(); ++i) t.push_back(t.back() + 2 * spacing_m / (v[i - 1] + v[i]));
  return t;
}

/// The nodes passed within the longest time, in order; at least the first.
std::vector<Vec3> passed_in_time(const std::vector<Vec3>& nodes, const std::vector<double>& t) {
  std::size_t n = 1;
  while (n < nodes.size() && t[n] <= kLongest_s) ++n;
  return {nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(n)};
}

}  // namespace

void describe(OptionTable& t, MotionLimits& o) {
  t.add("max_speed", o.max_speed_mps, "m/s", 0.1, 20, "greatest speed along a path");
  t.add("min_speed", o.min_speed_mps, "m/s", 0.05, 5, "bends are not flown slower than this");
  t.add("max_acceleration", o.max_acceleration_mps2, "m/s^2", 0.1, 20,
        "greatest acceleration along and across a path");
  t.add("max_jerk", o.max_jerk_mps3, "m/s^3", 0.5, 200, "greatest change of acceleration");
  t.add("max_heading_rate", o.max_heading_rate_radps, "rad/s", 0.05, 10, "greatest rate of turning");
  t.add("max_heading_acceleration", o.max_heading_acceleration_radps2, "rad/s^2", 0.05, 50,
        "greatest change of the rate of turning");
  t.add(
      "trajectory", o.trajectory,
      "how paths become motion: the paper's sampling, minimum-snap polynomials, or replanned with a receding "
      "horizon while exploring; above 2 m/s always the paper's (see " +
          doc_path("docs/planning.md") + ")");
}

TrajectorySample Trajectory::at(TimeNs t) const {
  if (samples.empty()) return {};
  if (t <= start) return samples.front();
  if (t >= end()) return samples.back();
  const auto i = static_cast<std::size_t>((t - start) / period);
  const double part = static_cast<double>((t - start) % period) / static_cast<double>(period);
  const TrajectorySample &a = samples[i], &b = samples[std::min(i + 1, samples.size() - 1)];
  return {a.position + (b.position - a.position) * part,
          wrap_angle(a.heading_rad + wrap_angle(b.heading_rad - a.heading_rad) * part), b.limited_by};
}

double greatest_start_speed_mps(const std::vector<Vec3>& points, const MotionLimits& limits) {
  const double length_m = path_length_m(points);
  if (length_m < 1e-6) return limits.max_speed_mps;
  const std::vector<Vec3> nodes = evenly_spaced(points, kMaxSpacing_m);
  const std::vector<double> turn = turns(nodes);
  const double spacing_m = length_m / static_cast<double>(nodes.size() - 1);
  std::vector<double> v;
  for (const double t : turn) v.push_back(bend_speed_mps(t, spacing_m, limits));
  v.back() = 0;
  slow_down_in_time(v, turn, spacing_m, limits);
  return v.front();
}

Trajectory sample_trajectory(const std::vector<Vec3>& points, double start_speed_mps, TimeNs start,
                             const MotionLimits& limits, const HeadingPlan& heading, const SlowPlaces& slow) {
  Trajectory out;
  out.start = start;
  out.period = kPeriod;
  if (points.empty()) return out;
  const double dt = seconds(kPeriod);
  HeadingCourse course(heading.start_heading_rad, limits, dt);
  out.samples.push_back({points.front(), wrap_angle(heading.start_heading_rad)});

  const double length = path_length_m(points);
  if (length > 1e-6) {
    const std::vector<Vec3> nodes = evenly_spaced(points, kMaxSpacing_m);
    const double spacing = length / static_cast<double>(nodes.size() - 1);
    const std::vector<double> wanted = wanted_headings(nodes, heading);
    if (turns_first(heading, wanted.front(), start_speed_mps)) {
      turn_on_the_spot(course, wanted.front(), out.samples);
      start_speed_mps = 0;
    }
    const Speeds timed = speeds(nodes, spacing, start_speed_mps, limits, wanted, slow);
    const std::vector<double>& v = timed.mps;
    const std::vector<double> t = times(v, spacing);
    // Too slow to arrive: fly as far as possible, to rest there. Each pass has fewer nodes, so this ends.
    if (!(t.back() <= kLongest_s))
      return sample_trajectory(passed_in_time(nodes, t), start_speed_mps, start, limits, heading, slow);
    const double turn_from = turn_from_s(heading, wanted.back(), t.back(), limits);
    // A turn begins earlier by this time, because the heading rate must build up.
    const double delay_s = 0.5 * limits.max_heading_rate_radps / limits.max_heading_acceleration_radps2;
    std::size_t i = 0, ahead = 0;
    const auto steps = static_cast<std::size_t>(std::ceil(t.back() / dt - 1e-9));
    for (std::size_t k = 1; k <= steps; ++k) {
      const double now = std::min(static_cast<double>(k) * dt, t.back());
      while (i + 2 < t.size() && t[i + 1] <= now) ++i;
      const double since = now - t[i], a = (v[i + 1] - v[i]) / (t[i + 1] - t[i]);
      const double u = static_cast<double>(i) + (v[i] * since + 0.5 * a * since * since) / spacing;
      while (ahead + 1 < t.size() && t[ahead] < now + delay_s) ++ahead;
      const double look = now >= turn_from ? *heading.goal_heading_rad : wanted[ahead];
      // Between two nodes the slower one tells why.
      out.samples.push_back({k == steps ? points.back() : point_at(nodes, u), course.step(look),
                             timed.limited_by[v[i + 1] < v[i] ? i + 1 : i]});
    }
  }
  if (heading.goal_heading_rad) end_facing(course, *heading.goal_heading_rad, out.samples);
  return out;
}

}  // namespace karst::core
