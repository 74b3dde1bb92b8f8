// Heading along a trajectory: the wanted heading, and a course to it within the turning limits.
#pragma once
#include <vector>

#include "core_stack/planning/trajectory/trajectory.h"

namespace karst::core {

/// Steers a heading to wanted values within rate and acceleration limits, one step per sample.
class HeadingCourse {
 public:
  HeadingCourse(double heading_rad, const MotionLimits& limits, double period_s, double rate_radps = 0)
      : heading_rad_(heading_rad), rate_radps_(rate_radps), limits_(limits), period_s_(period_s) {}
  double step(double wanted_rad);
  double heading_rad() const { return heading_rad_; }
  double rate_radps() const { return rate_radps_; }
  /// Whether the wanted heading is reached and the rate is small enough to stop in the next step.
  bool settled_at(double wanted_rad) const;

 private:
  double heading_rad_, rate_radps_;
  MotionLimits limits_;
  double period_s_;
};

/// Direction of travel seen from above at each of `points` (evenly spaced along the path): towards the point
/// `lookahead_m` farther on. Where the path is steep the last heading is kept, at the start
/// `start_heading_rad`.
std::vector<double> headings_along(const std::vector<Vec3>& points, double lookahead_m,
                                   double start_heading_rad);

/// Spreads the turn at each bend evenly from before to after it, so that the heading rate limits speed less.
/// `points` are evenly spaced.
std::vector<double> turned_early(const std::vector<Vec3>& points, const std::vector<double>& headings);
/// Turns `headings` near the look's place towards its heading.
void look_in_passing(const std::vector<Vec3>& points, const PassingLook& look, std::vector<double>& headings);

/// The headings wanted by `plan` at each of `points`, except for the goal's heading, which comes late.
std::vector<double> wanted_headings(const std::vector<Vec3>& points, const HeadingPlan& plan);
/// Whether a vehicle (nearly) at rest turns on the spot first, since it is far off the wanted heading.
bool turns_first(const HeadingPlan& plan, double wanted_rad, double speed_mps);
/// Adds samples at the last one's position until the heading is reached.
void turn_on_the_spot(HeadingCourse& course, double wanted_rad, std::vector<TrajectorySample>& samples);
/// When to begin turning to the goal's heading: as late as the rate allows, to look ahead until then.
/// Infinity if the goal has no heading.
double turn_from_s(const HeadingPlan& plan, double last_wanted_rad, double arrival_s,
                   const MotionLimits& limits);
/// Completes the turn to the goal's heading, and ends exactly in it.
void end_facing(HeadingCourse& course, double goal_heading_rad, std::vector<TrajectorySample>& samples);

}  // namespace karst::core
