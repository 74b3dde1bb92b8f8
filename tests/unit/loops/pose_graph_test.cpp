#include "core_stack/loops/pose_graph.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <Eigen/Dense>

#include "core_stack/common/random.h"
#include "core_stack/common/so3.h"

namespace {

using namespace karst::core;
using Vector6 = Eigen::Matrix<double, 6, 1>;

Vec3 vector_within(Random& r, double size) {
  return {r.uniform(-size, size), r.uniform(-size, size), r.uniform(-size, size)};
}
Pose random_pose(Random& r, double metres, double radians) {
  return {vector_within(r, metres), exp_so3(vector_within(r, radians))};
}
Pose moved(const Pose& T, const Vector6& d) {
  return {T.position + d.head<3>(), (T.orientation * exp_so3(d.tail<3>())).normalized()};
}
Matrix6 information_of(Random& r) {
  Matrix6 A;
  for (int i = 0; i < 36; ++i) A(i) = r.uniform(-1, 1);
  return A * A.transpose() + Matrix6::Identity();
}

/// A walk around a ring, and edges measured with noise: a chain, and `closures` more between random poses.
struct Graph {
  std::vector<Pose> truth, start;
  std::vector<GraphEdge> edges;
};
Graph graph_of(Random& r, std::size_t poses, std::size_t closures, double noise) {
  Graph g;
  // Turns mostly about the vertical, so that the z axes stay near up.
  const auto turn = [&](double radians) {
    return exp_so3(Vec3(0.05, 0.05, 1).cwiseProduct(vector_within(r, radians)));
  };
  g.truth.push_back({vector_within(r, 5), turn(1)});
  for (std::size_t i = 1; i < poses; ++i)
    g.truth.push_back(g.truth.back() * Pose{Vec3(4, 0, 0) + vector_within(r, 0.5), turn(0.4)});
  const auto edge = [&](std::size_t a, std::size_t b, bool robust) {
    const Pose error{vector_within(r, noise), exp_so3(vector_within(r, noise / 4))};
    g.edges.push_back({a, b, g.truth[a].inverse() * g.truth[b] * error, information_of(r), robust});
  };
  g.start.push_back(g.truth[0]);
  for (std::size_t i = 0; i + 1 < poses; ++i) {
    edge(i, i + 1, false);
    g.start.push_back(g.start.back() * g.edges.back().T_from_to);
  }
  for (std::size_t i = 0; i < closures; ++i) {
    const auto a = static_cast<std::size_t>(r.uniform(0, static_cast<double>(poses) - 1.001));
    edge(a, poses - 1 - a == a ? 0 : poses - 1 - a, false);
  }
  return g;
}

RC_GTEST_PROP(PoseGraph, TheDerivativesAreThoseOfNumericalDifferentiation, (std::uint64_t seed)) {
  Random r(seed);
  const GraphEdge edge{0, 1, random_pose(r, 5, 1), Matrix6::Identity(), false};
  const Pose from = random_pose(r, 5, 1), to = from * edge.T_from_to * random_pose(r, 1, 0.6);
  const EdgeError e = error_of(edge, from, to);
  const double h = 1e-5;
  for (int i = 0; i < 6; ++i) {
    const Vector6 d = h * Vector6::Unit(i);
    const Vector6 by_from =
        (error_of(edge, moved(from, d), to).error - error_of(edge, moved(from, -d), to).error) / (2 * h);
    const Vector6 by_to =
        (error_of(edge, from, moved(to, d)).error - error_of(edge, from, moved(to, -d)).error) / (2 * h);
    RC_ASSERT((by_from - e.by_from.col(i)).norm() < 1e-6);
    RC_ASSERT((by_to - e.by_to.col(i)).norm() < 1e-6);
  }
}

TEST(PoseGraph, OfMeasurementsWithoutErrorsIsTheTruth) {
  Random r(2);
  const Graph g = graph_of(r, 30, 10, 0);
  std::vector<Pose> start = g.truth;
  for (std::size_t i = 1; i < start.size(); ++i) start[i] = start[i] * random_pose(r, 0.5, 0.1);
  const PoseGraphResult result = optimize(start, g.edges, {});
  EXPECT_LT(result.cost, 1e-12);
  for (std::size_t i = 0; i < g.truth.size(); ++i) {
    EXPECT_LT((result.poses[i].position - g.truth[i].position).norm(), 1e-6) << i;
    EXPECT_LT(result.poses[i].orientation.angularDistance(g.truth[i].orientation), 1e-6) << i;
  }
}

// Along a line, an end that is measured d off moves by d n s^2 / (n s^2 + c^2): n edges of variance s^2
// against a closure of variance c^2; poses between move in proportion.
TEST(PoseGraph, SharesTheErrorOfALineInClosedForm) {
  constexpr std::size_t n = 20;
  constexpr double s2 = 0.01, c2 = 0.04, d = 0.7;
  std::vector<Pose> poses;
  std::vector<GraphEdge> edges;
  Matrix6 step = 1e6 * Matrix6::Identity(), closure = step;
  step.topLeftCorner<3, 3>() = Eigen::Matrix3d::Identity() / s2;
  closure.topLeftCorner<3, 3>() = Eigen::Matrix3d::Identity() / c2;
  for (std::size_t i = 0; i <= n; ++i) {
    poses.push_back({Vec3(4.0 * static_cast<double>(i), 0, 0), Quat::Identity()});
    if (i > 0) edges.push_back({i - 1, i, {Vec3(4, 0, 0), Quat::Identity()}, step, false});
  }
  edges.push_back({0, n, {Vec3(4.0 * n + d, 0, 0), Quat::Identity()}, closure, false});
  const PoseGraphResult result = optimize(poses, edges, {});
  for (std::size_t i = 0; i <= n; ++i)
    EXPECT_NEAR(result.poses[i].position.x(),
                4.0 * static_cast<double>(i) + d * static_cast<double>(i) * s2 / (n * s2 + c2), 1e-7)
        << i;
  EXPECT_NEAR(result.cost, d * d / (n * s2 + c2), 1e-7);
}

/// Gauss and Newton's method with numerical derivatives and a dense solver.
std::vector<Pose> solved_densely(std::vector<Pose> poses, const std::vector<GraphEdge>& edges,
                                 double up_sigma) {
  const auto unknowns = static_cast<Eigen::Index>(6 * (poses.size() - 1));
  const auto residuals = [&](const std::vector<Pose>& at) {
    Eigen::VectorXd all(static_cast<Eigen::Index>(6 * edges.size() + 2 * (at.size() - 1)));
    Eigen::Index row = 0;
    for (const GraphEdge& e : edges) {
      const Pose off = e.T_from_to.inverse() * at[e.from].inverse() * at[e.to];
      Vector6 error;
      error << off.position, log_so3(off.orientation);
      const Matrix6 root = e.information.llt().matrixU();
      all.segment<6>(row) = root * error;
      row += 6;
    }
    for (std::size_t i = 1; i < at.size(); ++i, row += 2)
      all.segment<2>(row) = (at[i].orientation * Vec3::UnitZ()).head<2>() / up_sigma;
    return all;
  };
  for (int step = 0; step < 150; ++step) {
    const Eigen::VectorXd r = residuals(poses);
    Eigen::MatrixXd J(r.size(), unknowns);
    const double h = 1e-6;
    for (Eigen::Index k = 0; k < unknowns; ++k) {
      std::vector<Pose> plus = poses, minus = poses;
      const auto i = static_cast<std::size_t>(k / 6 + 1);
      plus[i] = moved(poses[i], h * Vector6::Unit(k % 6));
      minus[i] = moved(poses[i], -h * Vector6::Unit(k % 6));
      J.col(k) = (residuals(plus) - residuals(minus)) / (2 * h);
    }
    const Eigen::VectorXd d = -J.colPivHouseholderQr().solve(r);
    for (std::size_t i = 1; i < poses.size(); ++i)
      poses[i] = moved(poses[i], d.segment<6>(static_cast<Eigen::Index>(6 * (i - 1))));
    if (d.norm() < 2e-5) break;
  }
  return poses;
}

TEST(PoseGraph, AgreesWithADenseSolution) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Random r(seed);
    const Graph g = graph_of(r, 14, 5, 0.1);
    PoseGraphOptions options;
    options.up_sigma_rad = seed % 2 == 0 ? 0.05 : 1e6;
    const PoseGraphResult sparse = optimize(g.start, g.edges, options);
    const std::vector<Pose> dense = solved_densely(g.start, g.edges, *options.up_sigma_rad);
    for (std::size_t i = 0; i < dense.size(); ++i) {
      EXPECT_LT((sparse.poses[i].position - dense[i].position).norm(), 2e-3) << seed << " " << i;
      EXPECT_LT(sparse.poses[i].orientation.angularDistance(dense[i].orientation), 2e-4) << seed << " " << i;
    }
  }
}

/// A ring of 60 poses with a drift of heading, and six true closures of its end with its begin.
Graph drifted_ring(bool with_false_closure) {
  Graph g;
  Matrix6 step = Matrix6::Zero(), closure = Matrix6::Zero();
  step.diagonal() << 2500, 2500, 2500, 250'000, 250'000, 250'000;
  closure.diagonal() << 1000, 1000, 1000, 100'000, 100'000, 100'000;
  const auto on_ring = [](std::size_t i) {
    const double a = 2 * std::numbers::pi * static_cast<double>(i) / 54;
    return Pose{Vec3(30 * std::sin(a), 30 - 30 * std::cos(a), 0), from_heading(a)};
  };
  g.start.push_back(on_ring(0));
  for (std::size_t i = 0; i < 60; ++i) {
    g.truth.push_back(on_ring(i));
    if (i == 0) continue;
    const Pose drifted{Vec3(0.02, 0.01, 0.01), from_heading(0.004)};
    g.edges.push_back({i - 1, i, on_ring(i - 1).inverse() * on_ring(i) * drifted, step, false});
    g.start.push_back(g.start.back() * g.edges.back().T_from_to);
  }
  for (std::size_t i = 54; i < 60; ++i)
    g.edges.push_back({i - 54, i, on_ring(i - 54).inverse() * on_ring(i), closure, true});
  if (with_false_closure) g.edges.push_back({10, 40, {Vec3(1, 0.5, 0), Quat::Identity()}, closure, true});
  return g;
}

double largest_error(const std::vector<Pose>& a, const std::vector<Pose>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i].position - b[i].position).norm());
  return most;
}

TEST(PoseGraph, TrueClosuresCountHoweverFarTheOdometryHasDrifted) {
  const Graph g = drifted_ring(false);
  EXPECT_GT(largest_error(g.start, g.truth), 5);
  const PoseGraphResult result = optimize(g.start, g.edges, {});
  for (std::size_t i = 59; i < g.edges.size(); ++i) EXPECT_GT(result.weights[i], 0.5);
  EXPECT_LT(largest_error(result.poses, g.truth), 1);
}

TEST(PoseGraph, AFalseClosureLosesItsWeightAndChangesNextToNothing) {
  const PoseGraphResult without = optimize(drifted_ring(false).start, drifted_ring(false).edges, {});
  const Graph g = drifted_ring(true);
  const PoseGraphResult with = optimize(g.start, g.edges, {});
  EXPECT_LT(with.weights.back(), 0.01);
  EXPECT_LT(largest_error(with.poses, without.poses), 0.1);
}

TEST(PoseGraph, OfOnePoseIsThatPose) {
  const std::vector<Pose> one{{Vec3(1, 2, 3), from_heading(1)}};
  EXPECT_EQ(optimize(one, {}, {}).poses[0].position, one[0].position);
}

TEST(PoseGraph, HasTheSameBytesEachTime) {
  const Graph g = drifted_ring(true);
  const auto a = optimize(g.start, g.edges, {}), b = optimize(g.start, g.edges, {});
  for (std::size_t i = 0; i < a.poses.size(); ++i) {
    EXPECT_EQ(a.poses[i].position, b.poses[i].position);
    EXPECT_EQ(a.poses[i].orientation.coeffs(), b.poses[i].orientation.coeffs());
  }
}

}  // namespace
