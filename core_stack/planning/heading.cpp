#include "core_stack/planning/heading.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace karst::core {
namespace {

constexpr double kLookahead_m = 0.8;
/// A vehicle that (nearly) stands turns on the spot first when it would start this far off its heading.
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
  constexpr double steepest = 0.25;  // horizontal share of a direction that still has a heading
  std::vector<double> out;
  double heading = start_heading_rad;
  std::size_t ahead = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    while (ahead + 1 < points.size() && (points[ahead] - points[i]).norm() < lookahead_m) ++ahead;
    const Vec3 d = points[ahead] - points[i];
    // Near the end what lies ahead is too short to give a direction: keep the last.
    const double horizontal = std::hypot(d.x(), d.y());
    if (horizontal > steepest * d.norm() && (d.norm() > 0.5 * lookahead_m || i == 0) && horizontal > 1e-6)
      heading = std::atan2(d.y(), d.x());
    out.push_back(heading);
  }
  return out;
}

std::vector<double> wanted_headings(const std::vector<Vec3>& points, const HeadingPlan& plan) {
  if (plan.along_path) return headings_along(points, kLookahead_m, plan.start_heading_rad);
  return std::vector<double>(points.size(), plan.goal_heading_rad.value_or(plan.start_heading_rad));
}

bool turns_first(const HeadingPlan& plan, double wanted_rad, double speed_mps) {
  return plan.along_path && speed_mps < kStanding_mps &&
         std::abs(wrap_angle(wanted_rad - plan.start_heading_rad)) > kTurnFirst_rad;
}

void turn_on_the_spot(HeadingCourse& course, double wanted_rad, std::vector<TrajectorySample>& samples) {
  const Vec3 here = samples.back().position;
  // A half turn at the least rate takes far fewer steps than this; the bound guards against absurd limits.
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
