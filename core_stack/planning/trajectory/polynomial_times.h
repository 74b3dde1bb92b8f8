// The durations of a minimum-snap polynomial's pieces: optimized for snap and time under soft limits
// (Richter, Bry and Roy 2016; the soft limits after Burri et al. 2015), then stretched until the limits hold.
#pragma once
#include <optional>

#include "core_stack/planning/trajectory/minimum_snap.h"
#include "core_stack/planning/trajectory/trajectory.h"

namespace karst::core {

/// Improves `durations_s` with NLopt in a fixed number of evaluations, rather than a time limit, so that a
/// flight can be repeated. Only the first kMaxOptimized pieces change.
std::vector<double> optimized_times(const std::vector<Vec3>& waypoints, std::vector<double> durations_s,
                                    const Departure& departure, const MotionLimits& limits, int evaluations);
constexpr std::size_t kMaxOptimized = 32;

/// Stretches durations until no limit is exceeded by more than kLimitTolerance. Nothing if that fails: with a
/// given initial velocity and acceleration, more time does not always help.
std::optional<Polynomial> within_limits(const std::vector<Vec3>& waypoints, std::vector<double> durations_s,
                                        const Departure& departure, const MotionLimits& limits);
constexpr double kLimitTolerance = 0.02;

}  // namespace karst::core
