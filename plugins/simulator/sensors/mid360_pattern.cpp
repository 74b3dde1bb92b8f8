#include "plugins/simulator/sensors/mid360_pattern.h"

#include <array>
#include <cmath>
#include <numbers>

namespace karst::sim {
namespace {

constexpr std::int64_t kLasers = 4;
constexpr std::int64_t kTurns = 1000,
                       kTurnsVolleys = 286'601;  // so many volleys of the lasers take so many turns
constexpr std::int64_t kSweepVolleys = 3911;     // from one end of the field of view to the other
constexpr std::array<double, kLasers> kSwing_deg = {4.5, 1.8, -1.2, -4.3};
constexpr double kLowestZenith_deg = 38, kHighestZenith_deg = 97, kMargin_deg = 4.5;

/// The remainder, 0 to divisor - 1.
std::int64_t modulo(std::int64_t a, std::int64_t divisor) { return (a % divisor + divisor) % divisor; }

}  // namespace

core::Vec3f mid360_direction(std::int64_t shot) {
  const std::int64_t laser = modulo(shot, kLasers), volley = (shot - laser) / kLasers;
  const double turn = static_cast<double>(modulo(volley * kTurns, kTurnsVolleys)) / kTurnsVolleys;
  const double azimuth = -2 * std::numbers::pi * turn;
  const std::int64_t slow = modulo(volley, 2 * kSweepVolleys);
  const double risen =
      static_cast<double>(slow < kSweepVolleys ? slow : 2 * kSweepVolleys - slow) / kSweepVolleys;
  const double zenith_deg = kLowestZenith_deg + kMargin_deg +
                            risen * (kHighestZenith_deg - kLowestZenith_deg - 2 * kMargin_deg) +
                            kSwing_deg[static_cast<std::size_t>(laser)] * std::sin(azimuth);
  const double zenith = zenith_deg * std::numbers::pi / 180;
  return core::Vec3(std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth),
                    std::cos(zenith))
      .cast<float>();
}

}  // namespace karst::sim
