#include "core_stack/planning/trajectory/polynomial_times.h"

#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace karst::core {
namespace {

/// Weight of a second of flight relative to snap (m^2/s^7): high, so that the limits are decisive.
constexpr double kTimeWeight = 300.0;
/// Cost of a limit that is just reached; it grows by a factor e with each kSoftness of the limit beyond.
constexpr double kLimitWeight = 10.0, kSoftness = 0.05;
/// Each duration may change by this factor up or down.
constexpr double kMaxChange = 3.0;
constexpr int kMaxStretches = 60;
/// Points in a piece at which limits are evaluated, ends included: by the optimizer, and in the final check.
constexpr int kLooks = 9, kCloseLooks = 33;

/// Derivatives of the powers of normalized time, one row per point.
Eigen::MatrixXd looks_at(int order, int looks) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(looks, 8);
  for (int i = 0; i < looks; ++i)
    for (int k = order; k < 8; ++k) {
      double factor = 1;
      for (int r = 0; r < order; ++r) factor *= k - r;
      out(i, k) = factor * std::pow(static_cast<double>(i) / (looks - 1), k - order);
    }
  return out;
}

/// Greatest speed, acceleration and jerk in a piece, each as a fraction of its limit.
template <int kCount>
Vec3 fractions_of_limits(const PolynomialPiece& piece, const MotionLimits& limits) {
  using Looks = Eigen::Matrix<double, kCount, 8>;
  static const Looks looks[] = {looks_at(1, kCount), looks_at(2, kCount), looks_at(3, kCount)};
  const double most[] = {limits.max_speed_mps, limits.max_acceleration_mps2, limits.max_jerk_mps3};
  Vec3 out;
  double scale = 1;
  for (int k = 0; k < 3; ++k) {
    scale *= piece.duration_s;
    const Eigen::Matrix<double, kCount, 3> values = looks[k] * piece.coefficients;
    out[k] = std::sqrt(values.rowwise().squaredNorm().maxCoeff()) / scale / most[k];
  }
  return out;
}

struct Problem {
  const std::vector<Vec3>& waypoints;
  const std::vector<double>& first_guess_s;
  const Departure& departure;
  const MotionLimits& limits;
  std::vector<double> durations_s;

  /// The unknowns are the logarithms of the ratio of each piece's duration to its initial guess.
  double cost(const double* x, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) durations_s[i] = first_guess_s[i] * std::exp(x[i]);
    const Polynomial polynomial = minimum_snap(waypoints, durations_s, departure);
    double sum = polynomial.snap_cost + kTimeWeight * polynomial.duration_s();
    for (const PolynomialPiece& piece : polynomial.pieces) {
      const Vec3 fractions = fractions_of_limits<kLooks>(piece, limits);
      for (int k = 0; k < 3; ++k)
        sum += kLimitWeight * std::exp(std::min((fractions[k] - 1) / kSoftness, 50.0));
    }
    return std::isfinite(sum) ? sum : 1e30;
  }
};

}  // namespace

std::vector<double> optimized_times(const std::vector<Vec3>& waypoints, std::vector<double> durations_s,
                                    const Departure& departure, const MotionLimits& limits, int evaluations) {
  const std::size_t n = std::min(durations_s.size(), kMaxOptimized);
  Problem problem{waypoints, durations_s, departure, limits, durations_s};
  const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> opt(
      nlopt_create(NLOPT_LN_SBPLX, static_cast<unsigned>(n)), nlopt_destroy);
  nlopt_set_min_objective(
      opt.get(),
      [](unsigned size, const double* x, double*, void* data) {
        return static_cast<Problem*>(data)->cost(x, size);
      },
      &problem);
  nlopt_set_lower_bounds1(opt.get(), -std::log(kMaxChange));
  nlopt_set_upper_bounds1(opt.get(), std::log(kMaxChange));
  nlopt_set_initial_step1(opt.get(), 0.1);
  nlopt_set_maxeval(opt.get(), evaluations);
  std::vector<double> x(n, 0.0);
  double least = 0;
  // On a roundoff failure x holds the best values so far, which are no worse than the guess.
  nlopt_optimize(opt.get(), x.data(), &least);
  for (std::size_t i = 0; i < n; ++i) durations_s[i] *= std::exp(x[i]);
  return durations_s;
}

std::optional<Polynomial> within_limits(const std::vector<Vec3>& waypoints, std::vector<double> durations_s,
                                        const Departure& departure, const MotionLimits& limits) {
  for (int round = 0; round < kMaxStretches; ++round) {
    Polynomial polynomial = minimum_snap(waypoints, durations_s, departure);
    double worst = 0;
    std::vector<double>
        ratios;  // of time, that would bring each piece to its limits were all stretched alike
    for (const PolynomialPiece& piece : polynomial.pieces) {
      const Vec3 fractions = fractions_of_limits<kCloseLooks>(piece, limits);
      if (!fractions.allFinite()) return std::nullopt;
      worst = std::max(worst, fractions.maxCoeff());
      ratios.push_back(std::max({fractions[0], std::sqrt(fractions[1]), std::cbrt(fractions[2])}));
    }
    if (worst <= 1 + kLimitTolerance) return polynomial;
    for (std::size_t i = 0; i < ratios.size(); ++i) {
      // A piece that is too fast is often due to its neighbours.
      double stretch = ratios[i];
      if (i > 0) stretch = std::max(stretch, std::sqrt(ratios[i - 1]));
      if (i + 1 < ratios.size()) stretch = std::max(stretch, std::sqrt(ratios[i + 1]));
      durations_s[i] *= std::clamp(stretch, 1.0, 1.5);
    }
  }
  return std::nullopt;
}

}  // namespace karst::core
