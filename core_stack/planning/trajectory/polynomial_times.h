// How long each piece of a minimum-snap polynomial lasts: optimized against snap and time under soft limits
// (Richter, Bry and Roy 2016; the soft limits after Burri et al. 2015), then stretched until the limits hold.
#pragma once
#include <optional>

#include "core_stack/planning/trajectory/minimum_snap.h"
#include "core_stack/planning/trajectory/trajectory.h"

namespace karst::core {

/// Better durations than `durations_s`, found by NLopt in just so many evaluations: never by the clock, so
/// that a flight can be repeated. Only the first kMaxOptimized pieces change.
std::vector<double> optimized_times(const std::vector<Vec3>& waypoints, std::vector<double> durations_s,
                                    const Departure& departure, const MotionLimits& limits, int evaluations);
constexpr std::size_t kMaxOptimized = 32;

/// Durations stretched where limits are exceeded, until none is by more than kLimitTolerance. Nothing if that
/// does not come about: given velocity and acceleration at the start, more time does not always help.
std::optional<Polynomial> within_limits(const std::vector<Vec3>& waypoints, std::vector<double> durations_s,
                                        const Departure& departure, const MotionLimits& limits);
constexpr double kLimitTolerance = 0.02;

}  // namespace karst::core
