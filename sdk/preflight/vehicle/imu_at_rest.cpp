#include "sdk/preflight/vehicle/imu_at_rest.h"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace karst::preflight {
namespace {

using core::Vec3;

constexpr std::size_t kRun = 3;  // samples at the limit, one after another: noise alone does not do that

struct Moments {
  Vec3 mean = Vec3::Zero(), deviation = Vec3::Zero();
};

Moments moments_of(const std::vector<Vec3>& values) {
  Moments m;
  if (values.empty()) return m;
  for (const Vec3& v : values) m.mean += v;
  m.mean /= static_cast<double>(values.size());
  for (const Vec3& v : values) m.deviation += (v - m.mean).cwiseAbs2();
  m.deviation = (m.deviation / static_cast<double>(values.size())).cwiseSqrt();
  return m;
}

/// The fraction of the values that stay at the greatest one, or at the least.
double at_limit(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  std::size_t clipped = 0;
  for (std::size_t i = 0; i < values.size();) {
    std::size_t run = 1;
    while (i + run < values.size() && values[i + run] == values[i]) ++run;
    if (run >= kRun && (values[i] == *low || values[i] == *high)) clipped += run;
    i += run;
  }
  return static_cast<double>(clipped) / static_cast<double>(values.size());
}

}  // namespace

double ImuAtRest::tilt_rad() const {
  const double length = mean_force_mps2.norm();
  return length > 0 ? std::acos(std::clamp(mean_force_mps2.z() / length, -1.0, 1.0)) : 0;
}

ImuAtRest imu_at_rest(std::span<const core::ImuSample> samples) {
  ImuAtRest out;
  std::vector<Vec3> force, rate;
  std::size_t repeated = 0;
  for (const core::ImuSample& s : samples) {
    if (!s.specific_force_mps2.allFinite() || !s.body_rate_radps.allFinite()) {
      ++out.invalid;
      continue;
    }
    if (!force.empty() && force.back() == s.specific_force_mps2 && rate.back() == s.body_rate_radps)
      ++repeated;
    force.push_back(s.specific_force_mps2);
    rate.push_back(s.body_rate_radps);
  }
  out.samples = static_cast<int>(force.size());
  if (force.empty()) return out;
  const Moments f = moments_of(force), r = moments_of(rate);
  out.mean_force_mps2 = f.mean;
  out.mean_rate_radps = r.mean;
  out.force_noise_mps2 = f.deviation.maxCoeff();
  out.rate_noise_radps = r.deviation.maxCoeff();
  const auto third = static_cast<std::ptrdiff_t>(force.size() / 3);
  if (third > 0)
    out.force_drift_mps2 = (moments_of({force.end() - third, force.end()}).mean -
                            moments_of({force.begin(), force.begin() + third}).mean)
                               .norm();
  out.repeated = static_cast<double>(repeated) / static_cast<double>(force.size());
  return out;
}

double clipped_fraction(std::span<const core::ImuSample> samples) {
  if (samples.empty()) return 0;
  double most = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> force, rate;
    for (const core::ImuSample& s : samples) {
      if (!s.specific_force_mps2.allFinite() || !s.body_rate_radps.allFinite()) continue;
      force.push_back(s.specific_force_mps2[axis]);
      rate.push_back(s.body_rate_radps[axis]);
    }
    if (!force.empty()) most = std::max({most, at_limit(force), at_limit(rate)});
  }
  return most;
}

}  // namespace karst::preflight
