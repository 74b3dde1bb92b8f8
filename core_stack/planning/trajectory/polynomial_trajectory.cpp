#include "core_stack/planning/trajectory/polynomial_trajectory.h"

#include <algorithm>
#include <cmath>

#include "core_stack/planning/trajectory/heading.h"
#include "core_stack/planning/trajectory/polynomial_times.h"

namespace karst::core {
namespace {

constexpr double kCornerTolerance_m = 0.15;
/// Maximal distance of waypoints: a long straight piece would reach the greatest speed at one point only.
constexpr double kMaxApart_m = 3.0;
constexpr double kMinApart_m = 0.02;
constexpr int kMaxRounds = 6, kFirstEvaluations = 500, kMoreEvaluations = 150;
/// Chord length for checking the curve against rock.
constexpr double kCheck_m = 0.1;

double deviation_m(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double l2 = d.squaredNorm(), t = l2 > 0 ? std::clamp((p - a).dot(d) / l2, 0.0, 1.0) : 0;
  return (p - a - t * d).norm();
}

std::vector<double> lengths_along(const std::vector<Vec3>& points) {
  std::vector<double> at{0};
  for (std::size_t i = 1; i < points.size(); ++i)
    at.push_back(at.back() + (points[i] - points[i - 1]).norm());
  return at;
}

/// Index of the point nearest to the middle of the path between two others; `from` if there is none between.
std::size_t middle(const std::vector<double>& at, std::size_t from, std::size_t to) {
  const double half = (at[from] + at[to]) / 2;
  std::size_t best = from;
  for (std::size_t i = from + 1; i < to; ++i)
    if (best == from || std::abs(at[i] - half) < std::abs(at[best] - half)) best = i;
  return best;
}

struct Splitting {
  const std::vector<Vec3>& points;
  std::vector<double> at;  // lengths along them
  double tolerance_m, max_m;
};

void split(const Splitting& s, std::size_t from, std::size_t to, std::vector<std::size_t>& out) {
  std::size_t farthest = from;
  double most = s.tolerance_m;
  for (std::size_t i = from + 1; i < to; ++i)
    if (const double d = deviation_m(s.points[i], s.points[from], s.points[to]); d > most)
      most = d, farthest = i;
  if (farthest == from && s.at[to] - s.at[from] > s.max_m) farthest = middle(s.at, from, to);
  if (farthest == from) return;
  split(s, from, farthest, out);
  out.push_back(farthest);
  split(s, farthest, to, out);
}

/// Points without duplicates, close enough together to choose waypoints from.
std::vector<Vec3> dense(const std::vector<Vec3>& points) {
  std::vector<Vec3> out;
  for (const Vec3& p : points) {
    if (out.empty()) {
      out.push_back(p);
      continue;
    }
    const Vec3 from = out.back();
    const double length = (p - from).norm();
    if (length < kMinApart_m) continue;
    const int n = static_cast<int>(std::ceil(length / kCheck_m));
    for (int i = 1; i <= n; ++i) out.push_back(from + (p - from) * (static_cast<double>(i) / n));
  }
  out.back() = points.back();
  return out;
}

/// Time of the sampled trajectory between consecutive waypoints: the initial guess.
std::vector<double> sampled_times(const std::vector<Vec3>& points, const std::vector<double>& at,
                                  const std::vector<std::size_t>& chosen, double speed_mps,
                                  const MotionLimits& limits) {
  HeadingPlan straight_on;
  straight_on.along_path = false;
  const Trajectory sampled = sample_trajectory(points, speed_mps, 0, limits, straight_on);
  std::vector<double> out;
  double flown_m = 0, last_s = 0;
  std::size_t k = 1;
  for (const std::size_t c : chosen) {
    if (c == 0) continue;
    double step_m = 0;
    while (k < sampled.samples.size()) {
      step_m = (sampled.samples[k].position - sampled.samples[k - 1].position).norm();
      if (flown_m + step_m >= at[c]) break;
      flown_m += step_m;
      ++k;
    }
    const double part = k < sampled.samples.size() && step_m > 0 ? (at[c] - flown_m) / step_m : 0;
    const double now_s = seconds(sampled.period) * (static_cast<double>(k - 1) + part);
    out.push_back(std::max(0.05, now_s - last_s));
    last_s = now_s;
  }
  return out;
}

bool is_clear(const PolynomialPiece& piece, double length_m, const SegmentClear& clear) {
  const int n = std::max(2, static_cast<int>(std::ceil(length_m / kCheck_m)));
  Vec3 from = piece.at(0, 0);
  for (int i = 1; i <= n; ++i) {
    const Vec3 to = piece.at(piece.duration_s * i / n, 0);
    if (!clear(from, to)) return false;
    from = to;
  }
  return true;
}

/// Samples positions and headings at the period of `out`; turns on the spot before and after if needed.
void sample(const Polynomial& polynomial, double start_speed_mps, const MotionLimits& limits,
            const HeadingPlan& heading, Trajectory& out) {
  const double dt = seconds(out.period), duration = polynomial.duration_s();
  const auto steps = static_cast<std::size_t>(std::ceil(duration / dt - 1e-9));
  std::vector<Vec3> positions;
  for (std::size_t k = 0; k <= steps; ++k)
    positions.push_back(polynomial.at(std::min(static_cast<double>(k) * dt, duration), 0));
  const std::vector<double> wanted = wanted_headings(positions, heading);
  HeadingCourse course(heading.start_heading_rad, limits, dt);
  out.samples = {{positions.front(), wrap_angle(heading.start_heading_rad)}};
  if (turns_first(heading, wanted.front(), start_speed_mps))
    turn_on_the_spot(course, wanted.front(), out.samples);
  const double turn_from = turn_from_s(heading, wanted.back(), duration, limits);
  for (std::size_t k = 1; k <= steps; ++k) {
    const bool late = static_cast<double>(k) * dt >= turn_from;
    out.samples.push_back({positions[k], course.step(late ? *heading.goal_heading_rad : wanted[k])});
  }
  if (heading.goal_heading_rad) end_facing(course, *heading.goal_heading_rad, out.samples);
}

}  // namespace

std::vector<std::size_t> corners(const std::vector<Vec3>& points, double tolerance_m, double max_m) {
  std::vector<std::size_t> out{0};
  split({points, lengths_along(points), tolerance_m, max_m}, 0, points.size() - 1, out);
  out.push_back(points.size() - 1);
  return out;
}

PolynomialTrajectory polynomial_trajectory(const std::vector<Vec3>& points, const Departure& departure,
                                           TimeNs start, const MotionLimits& limits,
                                           const HeadingPlan& heading, const SegmentClear& clear) {
  PolynomialTrajectory out;
  out.speed_limit_mps = limits.max_speed_mps;
  const auto fall_back = [&](const char* why) {
    out.trajectory = sample_trajectory(points, departure.velocity_mps.norm(), start, limits, heading);
    out.fell_back = why;
    return out;
  };
  if (points.empty()) return fall_back("there is no path");
  const std::vector<Vec3> path = dense(points);
  if (path.size() < 2) return fall_back("the path is too short");
  const std::vector<double> at = lengths_along(path);
  Departure from{at_most(departure.velocity_mps, limits.max_speed_mps),
                 at_most(departure.acceleration_mps2, limits.max_acceleration_mps2)};
  const double speed = from.velocity_mps.norm();
  if (turns_first(heading, wanted_headings(path, heading).front(), speed)) from = {};

  std::vector<std::size_t> chosen = corners(path, kCornerTolerance_m, kMaxApart_m);
  std::vector<double> durations = sampled_times(path, at, chosen, from.velocity_mps.norm(), limits);
  for (out.rounds = 1; out.rounds <= kMaxRounds; ++out.rounds) {
    std::vector<Vec3> waypoints;
    for (const std::size_t i : chosen) waypoints.push_back(path[i]);
    out.waypoints = waypoints.size();
    durations = optimized_times(waypoints, durations, from, limits,
                                out.rounds == 1 ? kFirstEvaluations : kMoreEvaluations);
    const std::optional<Polynomial> polynomial = within_limits(waypoints, durations, from, limits);
    if (!polynomial) return fall_back("the limits of motion could not be kept");

    std::vector<std::size_t> more{0};
    std::vector<double> guess;
    bool all_clear = true;
    for (std::size_t p = 0; p + 1 < chosen.size(); ++p) {
      const PolynomialPiece& piece = polynomial->pieces[p];
      const double length_m = at[chosen[p + 1]] - at[chosen[p]];
      const bool good = is_clear(piece, length_m, clear);
      all_clear = all_clear && good;
      const std::size_t between = good ? chosen[p] : middle(at, chosen[p], chosen[p + 1]);
      if (between != chosen[p]) {
        more.push_back(between);
        guess.insert(guess.end(), 2, piece.duration_s / 2);
      } else {
        guess.push_back(piece.duration_s);
      }
      more.push_back(chosen[p + 1]);
    }
    if (all_clear) {
      out.trajectory.start = start;
      sample(*polynomial, from.velocity_mps.norm(), limits, heading, out.trajectory);
      return out;
    }
    if (more.size() == chosen.size()) break;  // the path itself is not clear there
    chosen = std::move(more);
    durations = std::move(guess);
  }
  return fall_back("no polynomial of so many waypoints was clear");
}

}  // namespace karst::core
