#include "core_stack/planning/trajectory/minimum_snap.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>

#include "core_stack/common/random.h"

namespace karst::core {
namespace {

struct Problem {
  std::vector<Vec3> waypoints;
  std::vector<double> durations_s;
  Departure departure;
};

Vec3 random_vector(Random& r, double size) {
  return {r.uniform(-size, size), r.uniform(-size, size), r.uniform(-size, size)};
}

Problem random_problem(std::uint64_t seed, std::size_t pieces) {
  Random r(seed);
  Problem p;
  p.departure = {random_vector(r, 2), random_vector(r, 2)};
  p.waypoints.push_back(random_vector(r, 5));
  for (std::size_t i = 0; i < pieces; ++i) {
    p.waypoints.push_back(p.waypoints.back() + random_vector(r, 3));
    p.durations_s.push_back(r.uniform(0.3, 3));
  }
  return p;
}

double factor(int k, int order) { return order == 0 ? 1 : k * factor(k - 1, order - 1); }

/// The same program with nothing eliminated: coefficients of plain time as unknowns, all constraints with
/// Lagrange multipliers, in one dense system. Of degree 9, as in the article, with continuity up to snap.
double dense_kkt_cost(const Problem& p) {
  constexpr int kSize = 10;
  const auto pieces = static_cast<int>(p.durations_s.size());
  const int n = kSize * pieces, constraints = 2 * pieces + 4 + 4 * (pieces - 1);
  Eigen::MatrixXd q = Eigen::MatrixXd::Zero(n, n), a = Eigen::MatrixXd::Zero(constraints, n);
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(constraints, 3);
  int row = 0;
  // Unknowns are of time in units of the piece's duration, or the system could not be solved to enough
  // places.
  const auto derivative = [&](int piece, bool end, int order, double sign) {
    const double t = p.durations_s[static_cast<std::size_t>(piece)];
    for (int k = order; k < kSize; ++k)
      if (end || k == order) a(row, kSize * piece + k) += sign * factor(k, order) / std::pow(t, order);
  };
  for (int i = 0; i < pieces; ++i) {
    const double t = p.durations_s[static_cast<std::size_t>(i)];
    for (int j = 4; j < kSize; ++j)
      for (int k = 4; k < kSize; ++k)
        q(kSize * i + j, kSize * i + k) = factor(j, 4) * factor(k, 4) / (j + k - 7) / std::pow(t, 7);
    derivative(i, false, 0, 1), b.row(row++) = p.waypoints[static_cast<std::size_t>(i)];
    derivative(i, true, 0, 1), b.row(row++) = p.waypoints[static_cast<std::size_t>(i) + 1];
    for (int order = 1; i > 0 && order <= 4; ++order)
      derivative(i - 1, true, order, 1), derivative(i, false, order, -1), ++row;
  }
  derivative(0, false, 1, 1), b.row(row++) = p.departure.velocity_mps;
  derivative(0, false, 2, 1), b.row(row++) = p.departure.acceleration_mps2;
  derivative(pieces - 1, true, 1, 1), ++row;
  derivative(pieces - 1, true, 2, 1), ++row;
  Eigen::MatrixXd kkt = Eigen::MatrixXd::Zero(n + constraints, n + constraints);
  kkt << q / q.maxCoeff(), a.transpose(), a, Eigen::MatrixXd::Zero(constraints, constraints);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n + constraints, 3);
  right.bottomRows(constraints) = b;
  const Eigen::MatrixXd x = kkt.fullPivLu().solve(right).topRows(n);
  return (x.transpose() * q * x).trace();
}

double integral_of_squared_snap(const Polynomial& p) {
  double sum = 0;  // Simpson's rule: exact enough for a polynomial of degree 6 in so many steps
  for (const PolynomialPiece& piece : p.pieces) {
    constexpr int n = 200;
    for (int i = 0; i <= n; ++i)
      sum += (i == 0 || i == n ? 1 : (i % 2 ? 4 : 2)) * piece.at(piece.duration_s * i / n, 4).squaredNorm() *
             piece.duration_s / n / 3;
  }
  return sum;
}

std::vector<Vec3> ends_of(const PolynomialPiece& piece, double t_s) {
  return {piece.at(t_s, 0), piece.at(t_s, 1), piece.at(t_s, 2), piece.at(t_s, 3)};
}

/// The piece with the given derivatives at its ends.
PolynomialPiece through(const std::vector<Vec3>& begin, const std::vector<Vec3>& end, double duration_s) {
  Eigen::Matrix<double, 8, 8> a = Eigen::Matrix<double, 8, 8>::Zero();
  Eigen::Matrix<double, 8, 3> d;
  for (int order = 0; order < 4; ++order) {
    const double scale = std::pow(duration_s, order);
    a(order, order) = factor(order, order);
    for (int k = order; k < 8; ++k) a(4 + order, k) = factor(k, order);
    d.row(order) = scale * begin[static_cast<std::size_t>(order)];
    d.row(4 + order) = scale * end[static_cast<std::size_t>(order)];
  }
  return {duration_s, a.fullPivLu().solve(d)};
}

TEST(MinimumSnap, FromRestToRestItIsTheClosedForm) {
  // p'''' = c s (1 - s)(1 - 2s), which vanishes at the free ends, integrated four times.
  const double length = 6, duration = 4;
  const Polynomial p = minimum_snap({Vec3::Zero(), {length, 0, 0}}, {duration}, {});
  for (double s = 0; s <= 1.0001; s += 0.05) {
    const double expected =
        7 * std::pow(s, 3) - 21 * std::pow(s, 5) + 21 * std::pow(s, 6) - 6 * std::pow(s, 7);
    EXPECT_LT((p.at(s * duration, 0) - Vec3(length * expected, 0, 0)).norm(), 1e-12);
  }
  // Integral of (2520 s (1 - s)(1 - 2s))^2 = 2520^2 / 210.
  EXPECT_NEAR(p.snap_cost, 2520.0 * 2520 / 210 * length * length / std::pow(duration, 7), 1e-9);
}

TEST(MinimumSnap, PassesTheWaypointsFromTheDepartureToRest) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    const Problem p = random_problem(seed, *rc::gen::inRange<std::size_t>(1, 30));
    const Polynomial out = minimum_snap(p.waypoints, p.durations_s, p.departure);
    RC_ASSERT(out.pieces.size() == p.durations_s.size());
    RC_ASSERT((out.at(0, 1) - p.departure.velocity_mps).norm() < 1e-9);
    RC_ASSERT((out.at(0, 2) - p.departure.acceleration_mps2).norm() < 1e-9);
    double t = 0;
    for (std::size_t i = 0; i < p.waypoints.size(); ++i) {
      RC_ASSERT((out.at(t, 0) - p.waypoints[i]).norm() < 1e-7);
      if (i < p.durations_s.size()) t += p.durations_s[i];
    }
    RC_ASSERT(std::abs(t - out.duration_s()) < 1e-9);
    RC_ASSERT(out.at(t + 1, 1).norm() < 1e-6);
    RC_ASSERT(out.at(t + 1, 2).norm() < 1e-6);
  }));
}

TEST(MinimumSnap, JointsAreContinuousUpToTheSixthDerivative) {
  // Up to jerk by construction; the fourth to sixth only at the optimum.
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    const Problem p = random_problem(seed, 8);
    const Polynomial out = minimum_snap(p.waypoints, p.durations_s, p.departure);
    for (std::size_t i = 1; i < out.pieces.size(); ++i)
      for (int order = 0; order <= 6; ++order) {
        const PolynomialPiece &before = out.pieces[i - 1], &after = out.pieces[i];
        const Vec3 a = before.at(before.duration_s, order), b = after.at(0, order);
        double size = 1;  // rounding grows with what cancels in the sum
        for (int k = order; k < 8; ++k)
          for (const PolynomialPiece* piece : {&before, &after})
            size += factor(k, order) * piece->coefficients.row(k).norm() / std::pow(piece->duration_s, order);
        RC_ASSERT((a - b).norm() < 1e-6 * size);
      }
  }));
}

TEST(MinimumSnap, CostsWhatADenseSystemOfDegreeNineFinds) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    Problem p = random_problem(seed, *rc::gen::inRange<std::size_t>(1, 7));
    for (double& t : p.durations_s) t = 0.7 + 0.4 * t;  // less apart, for the dense system's sake
    const double cost = minimum_snap(p.waypoints, p.durations_s, p.departure).snap_cost;
    RC_ASSERT(std::abs(dense_kkt_cost(p) - cost) < 1e-5 * cost);
  }));
}

TEST(MinimumSnap, TheCostIsTheIntegralAndNoOtherCurveCostsLess) {
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    const Problem p = random_problem(seed, 5);
    Polynomial out = minimum_snap(p.waypoints, p.durations_s, p.departure);
    RC_ASSERT(std::abs(integral_of_squared_snap(out) - out.snap_cost) < 1e-6 * out.snap_cost);
    // Any other derivatives at a joint, with the pieces beside it through them.
    Random r(seed + 1);
    const std::size_t joint = 1 + r.bits() % (out.pieces.size() - 1);
    PolynomialPiece &before = out.pieces[joint - 1], &after = out.pieces[joint];
    std::vector<Vec3> derivatives{after.at(0, 0)};
    const double size = std::pow(10.0, r.uniform(-3, 0));
    for (int order = 1; order < 4; ++order)
      derivatives.push_back(after.at(0, order) + size * random_vector(r, 1));
    before = through(ends_of(before, 0), derivatives, before.duration_s);
    after = through(derivatives, ends_of(after, after.duration_s), after.duration_s);
    RC_ASSERT(integral_of_squared_snap(out) > out.snap_cost);
  }));
}

}  // namespace
}  // namespace karst::core
