#include "core_stack/localization/unordered_features.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstring>

#include "core_stack/localization/loam.h"
#include "tests/unit/localization/scattered.h"

namespace {

using namespace karst::core;
using namespace karst::test;

Features features_in(const World& world, double noise_m = 0, int threads = 1) {
  const auto model = scattered_lidar();
  model->T_body_lidar = Pose{};
  return find_unordered_features(
      to_sweep(scattered_scan(world, model, standing_at({}), kSecond, noise_m, Random(2)), 0.1).points, {},
      threads);
}

/// Distance to the nearest edge of a hollow box that is parallel to an axis.
double to_box_edge(const Vec3& p, const Vec3& low, const Vec3& high) {
  Vec3 wall;  // distance to the nearer wall of each axis
  for (int k = 0; k < 3; ++k) wall[k] = std::min(p[k] - low[k], high[k] - p[k]);
  std::sort(wall.data(), wall.data() + 3);
  return std::hypot(wall[0], wall[1]);
}

TEST(UnorderedFeatures, WallsArePlanesAndTheirCornersAreEdges) {
  const Vec3 low(-3, -4, -3), high(5, 4, 3);
  for (const double noise_m : {0.0, 0.02}) {
    const Features f = features_in(room({low, high}), noise_m);
    EXPECT_GT(f.planes.size(), 600u);
    EXPECT_GT(f.edges.size(), 30u);
    EXPECT_GT(f.surface.size(), 15000u);
    for (const Feature& e : f.edges) EXPECT_LT(to_box_edge(e.position.cast<double>(), low, high), 0.12);
    double nearest = 1;
    for (const Feature& p : f.planes)
      nearest = std::min(nearest, to_box_edge(p.position.cast<double>(), low, high));
    EXPECT_GT(nearest, 0.03);
  }
}

// A screen hides part of a wall behind it. Neither its silhouette nor the border of its shadow may become
// features.
TEST(UnorderedFeatures, WhereOneSurfaceHidesAnotherThereIsNothing) {
  const Features f = features_in(room({{-9, -9, -9}, {8, 9, 9}}, {{{3, -1, -9}, {3.1, 1, 9}}}));
  int on_screen = 0;
  for (const Feature& s : f.surface) {
    const double azimuth = std::atan2(s.position.y(), s.position.x());
    EXPECT_GT(std::abs(std::abs(azimuth) - std::atan2(1.0, 3.0)), 0.015) << s.position.transpose();
    on_screen += std::abs(s.position.x() - 3) < 0.01f;
  }
  EXPECT_GT(on_screen, 500);
}

TEST(UnorderedFeatures, TheBorderOfTheFieldOfViewAndGrazedRockAreLeftOut) {
  const Features ball = features_in(room({{-3, -3, -3}, {3, 3, 3}}));
  for (const Feature& s : ball.surface) {
    const float elevation = std::asin(s.position.z() / s.position.norm());
    EXPECT_LT(elevation, 0.9f - 0.005f);
    EXPECT_GT(elevation, -0.12f + 0.005f);
  }
  // A wall 1 m to the left along x: seen at less than 0.17 rad from 5.8 m on.
  const Features wall = features_in([](const Vec3& o, const Vec3& d) {
    return d.y() > 1e-6 ? (1 - o.y()) / d.y() : std::numeric_limits<double>::infinity();
  });
  ASSERT_FALSE(wall.surface.empty());
  for (const Feature& s : wall.surface) EXPECT_LT(s.position.norm(), 1 / std::sin(0.17) + 0.4);
}

TEST(UnorderedFeatures, AreTheSameForAnyNumberOfThreads) {
  const Features one = features_in(furnished_room(), 0.02, 1), three = features_in(furnished_room(), 0.02, 3);
  const auto same = [](const std::vector<Feature>& a, const std::vector<Feature>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Feature)) == 0;
  };
  EXPECT_TRUE(same(one.edges, three.edges) && same(one.planes, three.planes) &&
              same(one.surface, three.surface));
}

// A computer that is too slow asks for half the features: nothing was left out without rings.
TEST(UnorderedFeatures, HalfAreAboutHalfAndAmongThePlacesOfAll) {
  const auto model = scattered_lidar();
  model->T_body_lidar = Pose{};
  const Sweep sweep = to_sweep(
      scattered_scan(room({{-3, -4, -3}, {5, 4, 3}}), model, standing_at({}), kSecond, 0.02, Random(2)), 0.1);
  const Features all = find_unordered_features(sweep.points, {}, 1);
  const Features half = find_unordered_features(sweep.points, {}, 1, 0.5);
  const auto share = [](const auto& a, const auto& b) {
    return static_cast<double>(a.size()) / static_cast<double>(b.size());
  };
  EXPECT_NEAR(share(half.planes, all.planes), 0.5, 0.1);
  EXPECT_LT(share(half.edges, all.edges), 0.85) << "edges lie on lines: 0.7";
  EXPECT_GT(share(half.edges, all.edges), 0.5);
  EXPECT_EQ(half.surface.size(), all.surface.size());
}

RC_GTEST_PROP(UnorderedFeatures, AnyFinitePointsGiveFeaturesOutOfTheirMidst, ()) {
  const auto count = *rc::gen::inRange<std::size_t>(0, 300);
  std::vector<SweepPoint> points;
  for (std::size_t i = 0; i < count; ++i) {
    const auto number = [] { return 0.01f * static_cast<float>(*rc::gen::inRange(-200, 200)); };
    points.push_back({{number(), number(), 2.01f + number()}, -0.05f, 0, 0});
  }
  const Features f = find_unordered_features(points, {}, 1);
  for (const auto* list : {&f.edges, &f.planes, &f.surface})
    for (const Feature& feature : *list)
      RC_ASSERT(std::any_of(points.begin(), points.end(),
                            [&](const SweepPoint& p) { return p.position == feature.position; }));
}

// The same lap as with rings (loam_test.cpp), and the same bounds of the error.
class UnorderedLoam : public testing::TestWithParam<LoamEffort> {};
TEST_P(UnorderedLoam, FollowsAFlightInARoomWithinMillimetres) {
  const Motion lap = [](TimeNs t) {
    const double s = seconds(t);
    return Pose{{1.5 + 2 * std::cos(0.5 * s), -0.5 + 1.2 * std::sin(0.5 * s), 0.3 * std::sin(0.7 * s)},
                exp_so3({0, 0, 0.4 * s}) * exp_so3({0.1 * std::sin(2 * s), 0.1 * std::cos(1.7 * s), 0})};
  };
  const auto model = scattered_lidar();
  Loam loam({}, lap(100 * kMillisecond));
  const Pose error{{0.04, -0.03, 0.02}, exp_so3({0.01, 0, -0.015})};
  double worst_m = 0, worst_rad = 0;
  for (int i = 1; i <= 30; ++i) {
    const TimeNs stamp = i * 100 * kMillisecond;
    const Sweep sweep = to_sweep(
        scattered_scan(furnished_room(), model, lap, stamp, 0.02, Random(static_cast<std::uint64_t>(i))),
        0.2);
    ASSERT_FALSE(sweep.has_rings);
    const LoamPose pose = loam.process(sweep, states_of(lap, stamp, i == 1 ? Pose{} : error), GetParam());
    ASSERT_TRUE(pose.valid) << pose.problem;
    EXPECT_EQ(pose.free_directions, 0);
    const PoseError e = error_between(pose.T_world_body, lap(stamp));
    worst_m = std::max(worst_m, e.position_m), worst_rad = std::max(worst_rad, e.angle_rad);
  }
  EXPECT_LT(worst_m, 0.012);
  EXPECT_LT(worst_rad, 0.002);
}
INSTANTIATE_TEST_SUITE_P(Efforts, UnorderedLoam, testing::Values(LoamEffort::full, LoamEffort::half));

}  // namespace
