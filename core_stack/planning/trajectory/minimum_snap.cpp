#include "core_stack/planning/trajectory/minimum_snap.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace karst::core {
namespace {

constexpr int kEnd = 4;        // derivatives at an end: position, velocity, acceleration, jerk
constexpr int kBandwidth = 5;  // maximal index difference of coupled unknowns
using Matrix8 = Eigen::Matrix<double, 8, 8>;

/// k (k - 1) ... (k - order + 1)
double falling(int k, int order) {
  double out = 1;
  for (int i = 0; i < order; ++i) out *= k - i;
  return out;
}

/// The matrix A of the article for a piece of 1 s: derivatives at both ends from coefficients.
Matrix8 ends_from_coefficients() {
  Matrix8 a = Matrix8::Zero();
  for (int r = 0; r < kEnd; ++r) {
    a(r, r) = falling(r, r);
    for (int k = r; k < 8; ++k) a(kEnd + r, k) = falling(k, r);
  }
  return a;
}

/// A^-1 and A^-T Q A^-1 for a piece of 1 s; other durations scale them.
struct UnitPiece {
  Matrix8 coefficients_from_ends = ends_from_coefficients().inverse();
  Matrix8 snap;
  UnitPiece() {
    Matrix8 q = Matrix8::Zero();
    for (int i = 4; i < 8; ++i)
      for (int j = 4; j < 8; ++j) q(i, j) = falling(i, 4) * falling(j, 4) / (i + j - 7);
    snap = coefficients_from_ends.transpose() * q * coefficients_from_ends;
  }
};
const UnitPiece& unit_piece() {
  static const UnitPiece piece;
  return piece;
}

/// Powers of the duration that scale derivatives to normalized time.
Eigen::Matrix<double, 8, 1> time_scale(double duration_s) {
  Eigen::Matrix<double, 8, 1> s;
  for (int r = 0; r < kEnd; ++r) s[r] = s[kEnd + r] = std::pow(duration_s, r);
  return s;
}

/// Symmetric positive definite; stores only the diagonal and kBandwidth subdiagonals.
class BandedSystem {
 public:
  explicit BandedSystem(std::size_t n) : rows_(n), right_(n, Vec3::Zero()) {}
  void add(std::size_t i, std::size_t j, double v) {
    if (i >= j) rows_[i][i - j] += v;
  }
  void add_right(std::size_t i, const Vec3& v) { right_[i] += v; }
  /// Solves by Cholesky decomposition, in place.
  std::vector<Vec3> solve() {
    const std::size_t n = rows_.size();
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t first = i < kBandwidth ? 0 : i - kBandwidth;
      for (std::size_t j = first; j <= i; ++j) {
        double sum = rows_[i][i - j];
        for (std::size_t k = std::max(first, j < kBandwidth ? 0 : j - kBandwidth); k < j; ++k)
          sum -= rows_[i][i - k] * rows_[j][j - k];
        rows_[i][i - j] = i == j ? std::sqrt(sum) : sum / rows_[j][0];
      }
      for (std::size_t k = first; k < i; ++k) right_[i] -= rows_[i][i - k] * right_[k];
      right_[i] /= rows_[i][0];
    }
    for (std::size_t i = n; i-- > 0;) {
      for (std::size_t k = i + 1; k < std::min(n, i + kBandwidth + 1); ++k)
        right_[i] -= rows_[k][k - i] * right_[k];
      right_[i] /= rows_[i][0];
    }
    return std::move(right_);
  }

 private:
  std::vector<std::array<double, kBandwidth + 1>> rows_;  // [i][d]: element (i, i - d)
  std::vector<Vec3> right_;
};

/// Index of a derivative among the unknowns: jerk at the ends, all except position in between. -1: given.
int unknown(std::size_t waypoint, int derivative, std::size_t last) {
  if (waypoint == 0 || waypoint == last)
    return derivative < 3 ? -1 : (waypoint == 0 ? 0 : static_cast<int>(3 * last) - 2);
  return derivative == 0 ? -1 : static_cast<int>(3 * waypoint) - 3 + derivative;
}

}  // namespace

Vec3 PolynomialPiece::at(double t_s, int order) const {
  const double t = t_s / duration_s;
  Vec3 sum = Vec3::Zero();
  for (int k = 7; k >= order; --k) sum = sum * t + falling(k, order) * coefficients.row(k).transpose();
  return sum / std::pow(duration_s, order);
}

double Polynomial::duration_s() const {
  double sum = 0;
  for (const PolynomialPiece& p : pieces) sum += p.duration_s;
  return sum;
}

Vec3 Polynomial::at(double t_s, int order) const {
  std::size_t i = 0;
  for (; i + 1 < pieces.size() && t_s > pieces[i].duration_s; ++i) t_s -= pieces[i].duration_s;
  return pieces[i].at(std::clamp(t_s, 0.0, pieces[i].duration_s), order);
}

Polynomial minimum_snap(const std::vector<Vec3>& waypoints, const std::vector<double>& durations_s,
                        const Departure& departure) {
  const std::size_t last = waypoints.size() - 1;
  std::vector<std::array<Vec3, kEnd>> ends(waypoints.size());
  for (std::size_t i = 0; i <= last; ++i) ends[i] = {waypoints[i], Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  ends[0][1] = departure.velocity_mps;
  ends[0][2] = departure.acceleration_mps2;

  // The cost of a piece is d' H d, with d the derivatives at its ends. In the sum, factors of two unknowns
  // form the system's matrix; factors of an unknown and a given value form its right-hand side.
  BandedSystem system(3 * last - 1);
  std::vector<Matrix8> costs;
  for (std::size_t p = 0; p < last; ++p) {
    const double duration = durations_s[p];
    const auto scale = time_scale(duration);
    const Matrix8& h = costs.emplace_back(scale.asDiagonal() * unit_piece().snap * scale.asDiagonal() /
                                          std::pow(duration, 7));
    for (int r = 0; r < 8; ++r) {
      const int row = unknown(p + static_cast<std::size_t>(r / kEnd), r % kEnd, last);
      if (row < 0) continue;
      for (int c = 0; c < 8; ++c) {
        const std::size_t at = p + static_cast<std::size_t>(c / kEnd);
        const int column = unknown(at, c % kEnd, last);
        if (column >= 0)
          system.add(static_cast<std::size_t>(row), static_cast<std::size_t>(column), h(r, c));
        else
          system.add_right(static_cast<std::size_t>(row),
                           -h(r, c) * ends[at][static_cast<std::size_t>(c % kEnd)]);
      }
    }
  }
  const std::vector<Vec3> found = system.solve();
  for (std::size_t i = 0; i <= last; ++i)
    for (int r = 0; r < kEnd; ++r)
      if (const int k = unknown(i, r, last); k >= 0)
        ends[i][static_cast<std::size_t>(r)] = found[static_cast<std::size_t>(k)];

  Polynomial out;
  for (std::size_t p = 0; p < last; ++p) {
    Eigen::Matrix<double, 8, 3> d;
    for (int r = 0; r < 8; ++r)
      d.row(r) = ends[p + static_cast<std::size_t>(r / kEnd)][static_cast<std::size_t>(r % kEnd)];
    out.snap_cost += (d.transpose() * costs[p] * d).trace();
    out.pieces.push_back(
        {durations_s[p], unit_piece().coefficients_from_ends * time_scale(durations_s[p]).asDiagonal() * d});
  }
  return out;
}

}  // namespace karst::core
