// Heading along a trajectory: what it should be, and a course to it within the limits of turning.
#pragma once
#include <vector>

#include "core_stack/planning/trajectory/trajectory.h"

namespace karst::core {

/// Brings a heading to wanted values within rate and acceleration limits, one step a sample.
class HeadingCourse {
 public:
  HeadingCourse(double heading_rad, const MotionLimits& limits, double period_s)
      : heading_rad_(heading_rad), limits_(limits), period_s_(period_s) {}
  double step(double wanted_rad);
  double heading_rad() const { return heading_rad_; }
  double rate_radps() const { return rate_radps_; }
  /// The wanted heading is reached, and the rate small enough to stop with the next step.
  bool settled_at(double wanted_rad) const;

 private:
  double heading_rad_, rate_radps_ = 0;
  MotionLimits limits_;
  double period_s_;
};

/// Direction of travel seen from above at each of `points` (evenly spaced along the path): towards the point
/// `lookahead_m` farther on. Where the path is steep the last heading is kept, at the start
/// `start_heading_rad`.
std::vector<double> headings_along(const std::vector<Vec3>& points, double lookahead_m,
                                   double start_heading_rad);

/// `headings` at evenly spaced `points`, with bends turned through evenly, from before the bend until behind
/// it: so the rate of turning limits speed less.
std::vector<double> turned_early(const std::vector<Vec3>& points, const std::vector<double>& headings);
/// Turns `headings` towards the look near the place it is for.
void look_in_passing(const std::vector<Vec3>& points, const PassingLook& look, std::vector<double>& headings);

/// What `plan` wants at each of `points`, but for the goal's heading, which is turned to late.
std::vector<double> wanted_headings(const std::vector<Vec3>& points, const HeadingPlan& plan);
/// A vehicle that (nearly) stands turns first when it would start far off its heading.
bool turns_first(const HeadingPlan& plan, double wanted_rad, double speed_mps);
/// Adds samples at the last one's position until the heading is reached.
void turn_on_the_spot(HeadingCourse& course, double wanted_rad, std::vector<TrajectorySample>& samples);
/// When to begin turning to the goal's heading: as late as the rate allows, so as to look ahead until then.
/// Infinity if there is none.
double turn_from_s(const HeadingPlan& plan, double last_wanted_rad, double arrival_s,
                   const MotionLimits& limits);
/// Turns what is left to the goal's heading, and ends in it exactly.
void end_facing(HeadingCourse& course, double goal_heading_rad, std::vector<TrajectorySample>& samples);

}  // namespace karst::core
