#include "sdk/preflight/vehicle/hand_eye.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <cmath>

#include "core_stack/common/so3.h"
#include "sdk/preflight/vehicle/median.h"

namespace karst::preflight {
namespace {

using core::kMillisecond;
using core::TimeNs;
using core::Vec3;
using Eigen::Matrix3d;

constexpr std::size_t kMinPairs = 30;
constexpr TimeNs kMaxDelay = 500 * kMillisecond, kCoarse = 10 * kMillisecond, kFine = kMillisecond;
/// Two scans farther apart have another missing between them, over which the matching is weaker.
constexpr TimeNs kMaxStep = 500 * kMillisecond;
constexpr double kOutlier = 4;  // times the median residual

struct Pair {
  TimeNs from, to;
  Vec3 turn;
};

Vec3 turn_between(const core::Quat& from, const core::Quat& to) {
  return core::log_so3((from.conjugate() * to).normalized());
}

std::vector<Vec3> gyro_turns(std::span<const Orientation> track, const std::vector<Pair>& pairs,
                             TimeNs delay) {
  std::vector<Vec3> turns;
  turns.reserve(pairs.size());
  for (const Pair& p : pairs)
    turns.push_back(turn_between(orientation_at(track, p.from - delay), orientation_at(track, p.to - delay)));
  return turns;
}

struct LinearFit {
  Matrix3d map = Matrix3d::Identity(), gg = Matrix3d::Zero();
  double residual = 0, total = 0;  // sums of squares
};

LinearFit fit(const std::vector<Pair>& pairs, const std::vector<Vec3>& turns) {
  LinearFit f;
  Matrix3d rg = Matrix3d::Zero();
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    rg += pairs[k].turn * turns[k].transpose();
    f.gg += turns[k] * turns[k].transpose();
    f.total += pairs[k].turn.squaredNorm();
  }
  // A tiny ridge, for a motion about one axis only: the others are then undetermined, and said to be.
  f.map = rg * (f.gg + 1e-9 * (1 + f.gg.trace()) * Matrix3d::Identity()).inverse();
  for (std::size_t k = 0; k < pairs.size(); ++k)
    f.residual += (pairs[k].turn - f.map * turns[k]).squaredNorm();
  return f;
}

Matrix3d nearest_rotation(const Matrix3d& m) {
  const Eigen::JacobiSVD<Matrix3d> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vec3 sign = Vec3::Ones();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) sign.z() = -1;
  return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

/// The delay with the least residual, in steps of `step` around `centre`.
TimeNs best_delay(std::span<const Orientation> track, const std::vector<Pair>& pairs, TimeNs centre,
                  TimeNs reach, TimeNs step) {
  TimeNs best = centre;
  double least = std::numeric_limits<double>::infinity();
  for (TimeNs d = centre - reach; d <= centre + reach; d += step)
    if (const double r = fit(pairs, gyro_turns(track, pairs, d)).residual; r < least) {
      least = r;
      best = d;
    }
  return best;
}

/// Scan matching goes wrong now and then: such pairs are left out.
std::vector<Pair> without_outliers(const std::vector<Pair>& pairs, const std::vector<Vec3>& turns,
                                   const Matrix3d& map) {
  std::vector<double> residuals;
  for (std::size_t k = 0; k < pairs.size(); ++k) residuals.push_back((pairs[k].turn - map * turns[k]).norm());
  const double limit = kOutlier * median(residuals);
  std::vector<Pair> kept;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (residuals[k] <= limit) kept.push_back(pairs[k]);
  return kept;
}

/// From the curvature of the residual: S(d) = S0 + c (d - d0)^2 gives a variance of S0 / n / c.
double delay_sigma_s(std::span<const Orientation> track, const std::vector<Pair>& pairs, TimeNs delay,
                     double least) {
  constexpr TimeNs kAside = 20 * kMillisecond;
  const auto residual = [&](TimeNs d) { return fit(pairs, gyro_turns(track, pairs, d)).residual; };
  const double aside_s = core::seconds(kAside),
               curvature = (residual(delay - kAside) + residual(delay + kAside) - 2 * least) /
                           (2 * aside_s * aside_s);
  return curvature > 0 ? std::sqrt(least / (3.0 * static_cast<double>(pairs.size())) / curvature) : 1;
}

}  // namespace

std::optional<HandEye> hand_eye(std::span<const Orientation> track, std::span<const Orientation> lidar) {
  if (track.size() < 2) return {};
  std::vector<Pair> pairs;
  for (std::size_t i = 1; i < lidar.size(); ++i) {
    const TimeNs from = lidar[i - 1].stamp, to = lidar[i].stamp;
    if (to <= from || to - from > kMaxStep || from - kMaxDelay < track.front().stamp ||
        to + kMaxDelay > track.back().stamp)
      continue;
    pairs.push_back({from, to, turn_between(lidar[i - 1].q, lidar[i].q)});
  }
  if (pairs.size() < kMinPairs) return {};
  TimeNs delay = best_delay(track, pairs, 0, kMaxDelay, kCoarse);
  {
    const std::vector<Vec3> turns = gyro_turns(track, pairs, delay);
    pairs = without_outliers(pairs, turns, fit(pairs, turns).map);
  }
  delay = best_delay(track, pairs, delay, kCoarse, kFine);
  const std::vector<Vec3> turns = gyro_turns(track, pairs, delay);
  const LinearFit f = fit(pairs, turns);

  HandEye out;
  out.pairs = static_cast<int>(pairs.size());
  out.delay_s = core::seconds(delay);
  out.delay_sigma_s = delay_sigma_s(track, pairs, delay, f.residual);
  out.explained = f.total > 0 ? 1 - f.residual / f.total : 0;
  out.map = f.map;
  const Matrix3d error = nearest_rotation(f.map);
  out.error_rad = core::log_so3(core::Quat(error));
  out.scale = Eigen::JacobiSVD<Matrix3d>(f.map).singularValues().mean();
  double squares = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k) squares += (pairs[k].turn - error * turns[k]).squaredNorm();
  const double variance = squares / (3.0 * static_cast<double>(pairs.size()) - 3);
  const Eigen::SelfAdjointEigenSolver<Matrix3d> turned(f.gg);
  double squared_s2 = 0;
  for (const Pair& p : pairs) squared_s2 += core::seconds(p.to - p.from) * core::seconds(p.to - p.from);
  out.weakest_rate_radps = std::sqrt(std::max(0.0, turned.eigenvalues()[0]) / squared_s2);
  const Matrix3d information = f.gg.trace() * Matrix3d::Identity() - f.gg;
  const double least = Eigen::SelfAdjointEigenSolver<Matrix3d>(information).eigenvalues()[0];
  out.sigma_rad = least > 0 ? std::sqrt(variance / least) : std::numbers::pi;
  return out;
}

std::vector<TurnRate> turn_rates(std::span<const Orientation> track) {
  std::vector<TurnRate> rates;
  for (std::size_t i = 1; i < track.size(); ++i)
    if (const TimeNs dt = track[i].stamp - track[i - 1].stamp; dt > 0)
      rates.push_back({track[i].stamp, turn_between(track[i - 1].q, track[i].q).norm() / core::seconds(dt)});
  return rates;
}

}  // namespace karst::preflight
