#include "core_stack/localization/registration.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "core_stack/localization/features.h"
#include "core_stack/localization/sweep_motion.h"
#include "tests/unit/localization/worlds.h"

namespace {

using namespace karst::core;
using namespace karst::test;

Vec3 random_vector(Random& r, double size) {
  return {r.uniform(-size, size), r.uniform(-size, size), r.uniform(-size, size)};
}

Match random_match(Random& r) {
  Match m;
  m.normals = r.uniform() < 0.5 ? 1 : 2;
  m.p = random_vector(r, 10), m.q = random_vector(r, 10);
  const Quat q = exp_so3(random_vector(r, 3));
  m.n1 = q * Vec3::UnitX(), m.n2 = q * Vec3::UnitY();
  m.variance_m2 = r.uniform(1e-4, 1e-2);
  return m;
}

Pose moved(const Pose& T, const Vector6& change) {
  return {T.position + change.head<3>(), T.orientation * exp_so3(change.tail<3>())};
}

/// Half the weighted sum of squares, with the robust weights held.
double cost(const std::vector<Match>& matches, const Pose& T) {
  double sum = 0;
  for (const Match& m : matches) {
    const Vec3 d = T * m.p - m.q;
    sum += 0.5 * (std::pow(m.n1.dot(d), 2) + (m.normals == 2 ? std::pow(m.n2.dot(d), 2) : 0)) / m.variance_m2;
  }
  return sum;
}

RC_GTEST_PROP(Registration, TheJacobiansAreThoseOfNumericalDifferentiation, (std::uint64_t seed)) {
  Random r(seed);
  const Pose T{random_vector(r, 5), exp_so3(random_vector(r, 3))};
  const std::vector<Match> matches{random_match(r)};
  // A width so large that all robust weights are 1.
  const NormalEquations e = linearize(matches, T, 1e6, 1);
  Vector6 gradient;
  Matrix6 information = Matrix6::Zero();
  const double h = 1e-4;
  const auto residual = [&](const Vec3& n, const Pose& at) {
    return n.dot(at * matches[0].p - matches[0].q);
  };
  std::array<Vector6, 2> jacobian;
  for (int i = 0; i < 6; ++i) {
    const Pose plus = moved(T, h * Vector6::Unit(i)), minus = moved(T, -h * Vector6::Unit(i));
    gradient[i] = (cost(matches, plus) - cost(matches, minus)) / (2 * h);
    jacobian[0][i] = (residual(matches[0].n1, plus) - residual(matches[0].n1, minus)) / (2 * h);
    jacobian[1][i] = (residual(matches[0].n2, plus) - residual(matches[0].n2, minus)) / (2 * h);
  }
  for (int k = 0; k < matches[0].normals; ++k)
    information += jacobian[static_cast<std::size_t>(k)] * jacobian[static_cast<std::size_t>(k)].transpose() /
                   matches[0].variance_m2;
  RC_ASSERT((e.gradient - gradient).norm() < 1e-5 * (1 + gradient.norm()));
  RC_ASSERT((e.information - information).norm() < 1e-5 * (1 + information.norm()));
}

TEST(Registration, SumsHaveTheSameBytesForAnyNumberOfThreads) {
  Random r(1);
  std::vector<Match> matches;
  for (int i = 0; i < 3000; ++i) matches.push_back(random_match(r));
  const NormalEquations one = linearize(matches, {}, 0.3, 1);
  for (const int threads : {2, 3, 4}) {
    const NormalEquations more = linearize(matches, {}, 0.3, threads);
    EXPECT_EQ(one.information, more.information);
    EXPECT_EQ(one.gradient, more.gradient);
    EXPECT_EQ(one.squared, more.squared);
  }
}

std::vector<Match> planes(const std::vector<Vec3>& normals, Random& r) {
  std::vector<Match> matches;
  for (const Vec3& n : normals)
    for (int i = 0; i < 200; ++i) {
      Match m;
      m.normals = 1, m.n1 = n, m.variance_m2 = 1e-4;
      m.q = 5 * n + (Eigen::Matrix3d::Identity() - n * n.transpose()) * random_vector(r, 6);
      m.p = m.q;
      matches.push_back(m);
    }
  return matches;
}

/// The largest deviation along each free direction must be the one of "free", along all others small.
void expect_free(const Step& step, const std::vector<Vector6>& free) {
  EXPECT_EQ(step.free_directions, static_cast<int>(free.size()));
  for (const Vector6& d : free) EXPECT_GT(d.dot(step.covariance * d), 50 * 50) << d.transpose();
}

TEST(Registration, FreeDirectionsAreThoseThatNoSurfaceMeasures) {
  Random r(2);
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  const auto unit = [](int i) -> Vector6 { return Vector6::Unit(i); };
  expect_free(solve(linearize(planes({x, -x, y, -y, z, -z}, r), {}, 1, 1), 0.002, 0.002), {});
  expect_free(solve(linearize(planes({y, -y, z, -z}, r), {}, 1, 1), 0.002, 0.002), {unit(0)});
  const Step floor = solve(linearize(planes({-z}, r), {}, 1, 1), 0.002, 0.002);
  EXPECT_EQ(floor.free_directions, 3);
  for (const int i : {0, 1}) EXPECT_GT(floor.covariance(i, i), 50 * 50);
  EXPECT_LT(floor.covariance(2, 2), 1e-4);
  EXPECT_LT(floor.covariance(3, 3), 1e-4);
  EXPECT_LT(floor.covariance(4, 4), 1e-4);
  EXPECT_GT(floor.covariance(5, 5), 1);
}

// A mean squared cosine of 0.0064 with the normals.
TEST(Registration, TheVerticalHasALimitOfItsOwn) {
  Random r(4);
  const auto walls = [](const Vec3& along, const Vec3& a, const Vec3& b) {
    const Vec3 tilt = 0.08 * along;
    return std::vector<Vec3>{(a + tilt).normalized(), (tilt - a).normalized(), (b + tilt).normalized(),
                             (tilt - b).normalized()};
  };
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  const NormalEquations shaft = linearize(planes(walls(z, x, y), r), {}, 1, 1),
                        corridor = linearize(planes(walls(x, y, z), r), {}, 1, 1);
  expect_free(solve(shaft, 0.002, 0.01), {Vector6::Unit(2)});
  expect_free(solve(shaft, 0.002, 0.002), {});
  expect_free(solve(corridor, 0.002, 0.01), {});
  expect_free(solve(corridor, 0.01, 0.01), {Vector6::Unit(0)});
}

TEST(Registration, NothingMovesAlongAFreeDirection) {
  Random r(3);
  std::vector<Match> corridor = planes({Vec3::UnitY(), -Vec3::UnitY(), Vec3::UnitZ(), -Vec3::UnitZ()}, r);
  for (Match& m : corridor) m.p += Vec3(0.3, 0.2, -0.1);
  const Step step = solve(linearize(corridor, {}, 1, 1), 0.002, 0.002);
  EXPECT_NEAR(step.change[0], 0, 1e-9);
  EXPECT_NEAR(step.change[1], -0.2, 0.01);
  EXPECT_NEAR(step.change[2], 0.1, 0.01);
}

Cloud cloud_of(const World& world, const Pose& T, std::uint64_t seed, double noise_m) {
  const Sweep sweep = sweep_of(world, lidar(32, 512), standing_at(T), kSecond, noise_m, seed);
  const Features f = find_features(sweep.points, {}, 1);
  Cloud cloud;
  const auto add = [&](const std::vector<Feature>& from, std::vector<Vec3f>& to) {
    for (const Feature& x : from)
      to.push_back((sweep.T_body_lidar * x.position.cast<double>()).cast<float>());
  };
  add(f.edges, cloud.edges), add(f.planes, cloud.planes), add(f.surface, cloud.surface);
  return cloud;
}

/// Fits a sweep taken at a random place to a map of sweeps at others, from a guess that is wrong by up to
/// `wrong_m` and `wrong_rad` an axis.
PoseError recovered(std::uint64_t seed, double wrong_m, double wrong_rad, std::size_t first_level) {
  Random r(seed);
  const World world = furnished_room();
  LocalMap map{LocalMapOptions{}};
  for (int i = 0; i < 4; ++i) {
    const Pose T{Vec3(0.6 * i, 0.2 * i, 0), exp_so3(random_vector(r, 0.2))};
    map.insert(transformed(T, cloud_of(world, T, seed + static_cast<std::uint64_t>(i), 0.02)), T.position);
  }
  const Pose truth{Vec3(0.9, 0.5, 0.2), exp_so3(random_vector(r, 0.2))};
  const Pose guess{truth.position + random_vector(r, wrong_m),
                   truth.orientation * exp_so3(random_vector(r, wrong_rad))};
  Workspace workspace;
  const Fit fit = fit_to_map(cloud_of(world, truth, seed + 99, 0.02), map, guess, first_level, {}, workspace);
  EXPECT_TRUE(fit.good);
  EXPECT_EQ(fit.free_directions, 0);
  return error_between(fit.T_world_body, truth);
}

TEST(Registration, RecoversATransformInARoomToMillimetres) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const PoseError e = recovered(seed, 0.05, 0.01, 0);
    EXPECT_LT(e.position_m, 0.004) << seed;
    EXPECT_LT(e.angle_rad, 0.001) << seed;
  }
}

TEST(Registration, RecoversAFarGuessByStartingAtTheCoarsestLevel) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const PoseError e = recovered(seed, 0.4, 0.06, 2);
    EXPECT_LT(e.position_m, 0.004) << seed;
    EXPECT_LT(e.angle_rad, 0.001) << seed;
  }
}

TEST(Registration, ASweepOfAnotherPlaceIsNotGood) {
  const World elsewhere = room({{50, 50, 50}, {60, 58, 54}});
  LocalMap map{LocalMapOptions{}};
  map.insert(cloud_of(furnished_room(), {}, 1, 0.02), Vec3::Zero());
  Workspace workspace;
  const Pose far{{55, 54, 52}, Quat::Identity()};
  EXPECT_FALSE(fit_to_map(cloud_of(elsewhere, far, 2, 0.02), map, far, 0, {}, workspace).good);
  EXPECT_FALSE(fit_to_map({}, map, {}, 0, {}, workspace).good);
}

}  // namespace
