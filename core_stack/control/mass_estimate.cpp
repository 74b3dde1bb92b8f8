#include "core_stack/control/mass_estimate.h"

#include <algorithm>
#include <cmath>

namespace karst::core {
namespace {

constexpr double kLag_s = 0.2;
/// The lagged values are of the air only after this long.
constexpr double kSettled_s = 0.5;
/// Averaged over the time in the air at first, over this long later: gusts come and go within seconds.
constexpr double kMinMemory_s = 0.5, kMaxMemory_s = 20.0;
constexpr double kMinFraction = 0.5, kMaxFraction = 2.0;  // of the mass described

}  // namespace

MassEstimate::MassEstimate(double described_kg) : described_kg_(described_kg), mass_kg_(described_kg) {}

void MassEstimate::reset() { *this = MassEstimate(described_kg_); }

void MassEstimate::on_specific_force(double up_mps2) {
  if (!std::isfinite(up_mps2)) return;
  sample_sum_mps2_ += up_mps2;
  ++samples_;
}

void MassEstimate::update(double thrust_n, bool airborne, double dt_s) {
  if (samples_ == 0) return;
  const double force_mps2 = sample_sum_mps2_ / samples_;
  sample_sum_mps2_ = samples_ = 0;
  if (!airborne) {
    airborne_s_ = 0;
    return;
  }
  const double fraction = airborne_s_ == 0 ? 1 : dt_s / (kLag_s + dt_s);
  thrust_n_ += fraction * (thrust_n - thrust_n_);
  force_mps2_ += fraction * (force_mps2 - force_mps2_);
  airborne_s_ += dt_s;
  if (airborne_s_ < kSettled_s || force_mps2_ < 1) return;
  const double memory_s = std::clamp(airborne_s_ - kSettled_s, kMinMemory_s, kMaxMemory_s);
  mass_kg_ += dt_s / memory_s * (thrust_n_ / force_mps2_ - mass_kg_);
  mass_kg_ = std::clamp(mass_kg_, kMinFraction * described_kg_, kMaxFraction * described_kg_);
}

}  // namespace karst::core
