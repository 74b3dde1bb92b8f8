#include "core_stack/planning/trajectory/heading.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace karst::core {
namespace {

constexpr double kLookahead_m = 0.8;
/// The heading turns over this length before and after a bend: a right angle at 2 m/s and 1 rad/s.
constexpr double kBend_m = 1.5;
/// Maximal deviation from the direction of flight, so that the space ahead stays in a camera's view.
constexpr double kAside_rad = 0.6;
/// Tolerance of the heading when passing a viewpoint, and the heading change per metre near it.
constexpr double kPassing_rad = 0.3, kPassing_radpm = 0.8;
/// A vehicle that (nearly) stands first turns on the spot if its heading is off by more than this.
constexpr double kTurnFirst_rad = 0.7, kStanding_mps = 0.2;
constexpr double kHeadingReached_rad = 1e-3;

}  // namespace

double HeadingCourse::step(double wanted_rad) {
  const double error = wrap_angle(wanted_rad - heading_rad_);
  const double alpha = limits_.max_heading_acceleration_radps2;
  // The fastest rate from which the turn can still stop at the wanted heading, in whole steps of the period:
  // braking by alpha * period a step covers rate^2 / (2 alpha) + rate * period / 2.
  const double half = 0.5 * alpha * period_s_;
  const double braking = std::sqrt(half * half + 2 * alpha * std::abs(error)) - half;
  double rate = std::min({limits_.max_heading_rate_radps, braking, std::abs(error) / period_s_});
  rate = std::copysign(rate, error);
  rate_radps_ = std::clamp(rate, rate_radps_ - alpha * period_s_, rate_radps_ + alpha * period_s_);
  heading_rad_ = wrap_angle(heading_rad_ + rate_radps_ * period_s_);
  return heading_rad_;
}

bool HeadingCourse::settled_at(double wanted_rad) const {
  const double slow = limits_.max_heading_acceleration_radps2 * period_s_;
  return std::abs(wrap_angle(wanted_rad - heading_rad_)) < kHeadingReached_rad &&
         std::abs(rate_radps_) <= slow;
}

std::vector<double> headings_along(const std::vector<Vec3>& points, double lookahead_m,
                                   double start_heading_rad) {
  constexpr double steepest = 0.25;  // horizontal part below which a direction has no heading
  std::vector<double> out;
  double heading = start_heading_rad;
  std::size_t ahead = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    while (ahead + 1 < points.size() && (points[ahead] - points[i]).norm() < lookahead_m) ++ahead;
    const Vec3 d = points[ahead] - points[i];
    // Near the end the remaining path is too short to give a direction: keep the last one.
    const double horizontal = std::hypot(d.x(), d.y());
    if (horizontal > steepest * d.norm() && (d.norm() > 0.5 * lookahead_m || i == 0) && horizontal > 1e-6)
      heading = std::atan2(d.y(), d.x());
    out.push_back(heading);
  }
  return out;
}

std::vector<double> turned_early(const std::vector<Vec3>& points, const std::vector<double>& headings) {
  std::vector<double> sum{0}, all;  // unwrapped, and their sums
  for (const double h : headings) {
    all.push_back(all.empty() ? h : all.back() + wrap_angle(h - all.back()));
    sum.push_back(sum.back() + all.back());
  }
  double length_m = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length_m += (points[i] - points[i - 1]).norm();
  const auto half_window =
      static_cast<std::size_t>(kBend_m * static_cast<double>(points.size()) / std::max(length_m, kBend_m));
  std::vector<double> out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::size_t half = std::min({half_window, i, all.size() - 1 - i});
    const double mean = (sum[i + half + 1] - sum[i - half]) / static_cast<double>(2 * half + 1);
    out.push_back(wrap_angle(std::clamp(mean, all[i] - kAside_rad, all[i] + kAside_rad)));
  }
  return out;
}

void look_in_passing(const std::vector<Vec3>& points, const PassingLook& look,
                     std::vector<double>& headings) {
  const auto nearest = std::min_element(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) {
    return (a - look.place).squaredNorm() < (b - look.place).squaredNorm();
  });
  const auto at = static_cast<std::size_t>(nearest - points.begin());
  const auto turn_towards = [&](std::size_t i, double away_m) {
    const double max_rad = kPassing_rad + kPassing_radpm * away_m;
    const double off_rad = wrap_angle(headings[i] - look.heading_rad);
    headings[i] = wrap_angle(look.heading_rad + std::clamp(off_rad, -max_rad, max_rad));
  };
  double away_m = 0;
  turn_towards(at, away_m);
  for (std::size_t i = at + 1; i < points.size(); ++i)
    turn_towards(i, away_m += (points[i] - points[i - 1]).norm());
  away_m = 0;
  for (std::size_t i = at; i-- > 0;) turn_towards(i, away_m += (points[i + 1] - points[i]).norm());
}

std::vector<double> wanted_headings(const std::vector<Vec3>& points, const HeadingPlan& plan) {
  if (!plan.along_path)
    return std::vector<double>(points.size(), plan.goal_heading_rad.value_or(plan.start_heading_rad));
  std::vector<double> headings =
      turned_early(points, headings_along(points, kLookahead_m, plan.start_heading_rad));
  if (plan.passing) look_in_passing(points, *plan.passing, headings);
  return headings;
}

bool turns_first(const HeadingPlan& plan, double wanted_rad, double speed_mps) {
  return plan.along_path && speed_mps < kStanding_mps &&
         std::abs(wrap_angle(wanted_rad - plan.start_heading_rad)) > kTurnFirst_rad;
}

void turn_on_the_spot(HeadingCourse& course, double wanted_rad, std::vector<TrajectorySample>& samples) {
  const Vec3 here = samples.back().position;
  // A half turn at the lowest rate takes far fewer steps than this; the bound guards against absurd limits.
  for (int i = 0; i < 100000 && !course.settled_at(wanted_rad); ++i)
    samples.push_back({here, course.step(wanted_rad)});
}

double turn_from_s(const HeadingPlan& plan, double last_wanted_rad, double arrival_s,
                   const MotionLimits& limits) {
  if (!plan.goal_heading_rad) return std::numeric_limits<double>::infinity();
  return arrival_s -
         std::abs(wrap_angle(*plan.goal_heading_rad - last_wanted_rad)) / limits.max_heading_rate_radps -
         limits.max_heading_rate_radps / limits.max_heading_acceleration_radps2;
}

void end_facing(HeadingCourse& course, double goal_heading_rad, std::vector<TrajectorySample>& samples) {
  turn_on_the_spot(course, goal_heading_rad, samples);
  samples.back().heading_rad = wrap_angle(goal_heading_rad);
}

}  // namespace karst::core
