#include "core_stack/localization/features.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstring>

#include "tests/unit/localization/worlds.h"

namespace {

using namespace karst::core;
using namespace karst::test;

/// One ring of 1024 columns; `range(azimuth)` in metres, NaN or infinity for no return.
std::vector<SweepPoint> ring(const std::function<double(double)>& range, std::uint16_t index = 0) {
  std::vector<SweepPoint> points;
  for (int j = 0; j < 1024; ++j) {
    const double azimuth = std::numbers::pi * (1 - 2 * (j + 0.5) / 1024), r = range(azimuth);
    if (!std::isfinite(r)) continue;
    const Vec3 p = r * Vec3(std::cos(azimuth), std::sin(azimuth), 0);
    points.push_back({p.cast<float>(), static_cast<float>(-0.1 + 0.1 * (j + 1) / 1024), index, 0});
  }
  return points;
}

/// A square room of half width 5 m.
double square(double azimuth) {
  return 5 / std::max(std::abs(std::cos(azimuth)), std::abs(std::sin(azimuth)));
}

TEST(Features, TheCornersOfASquareRoomAreItsEdges) {
  const Features f = find_features(ring(square), {}, 1);
  ASSERT_EQ(f.edges.size(), 4u);
  for (const Feature& e : f.edges)
    EXPECT_LT((e.position.cast<double>().cwiseAbs() - Vec3(5, 5, 0)).norm(), 0.05) << e.position.transpose();
}

TEST(Features, PlanarFeaturesLieOnTheWallsAwayFromTheCornersOneASectorAtMost) {
  const FeatureOptions o;
  const Features f = find_features(ring(square), o, 1);
  EXPECT_LE(static_cast<std::int64_t>(f.planes.size()), o.plane_sectors);
  EXPECT_GE(static_cast<std::int64_t>(f.planes.size()), o.plane_sectors * 3 / 4);
  for (const Feature& p : f.planes) {
    EXPECT_NEAR(p.position.cwiseAbs().maxCoeff(), 5, 1e-4);
    EXPECT_LT(p.position.cwiseAbs().head<2>().minCoeff(), 4.9);
  }
}

TEST(Features, ARoundWallHasNoEdges) {
  EXPECT_TRUE(find_features(ring([](double) { return 5; }), {}, 1).edges.empty());
}

TEST(Features, TheBorderOfWhatHidesAWallIsNoEdgeAndNoSurface) {
  // A disc of the wall's own curvature, 2 m nearer, from -20 to 20 degrees: both its borders only end what is
  // seen.
  const auto range = [](double a) { return std::abs(a) < 0.35 ? 3.0 : 5.0; };
  const Features f = find_features(ring(range), {}, 1);
  EXPECT_TRUE(f.edges.empty());
  for (const Feature& s : f.surface) {
    const double azimuth = std::atan2(s.position.y(), s.position.x());
    EXPECT_GT(std::abs(std::abs(azimuth) - 0.35), 0.02);  // windows keep to one side
  }
  EXPECT_FALSE(f.surface.empty());
}

TEST(Features, WindowsDoNotReachAcrossAGap) {
  const auto range = [](double a) { return std::abs(a) < 0.2 ? std::nan("") : square(a); };
  const Features f = find_features(ring(range), {}, 1);
  EXPECT_EQ(f.edges.size(), 4u);
  for (const Feature& s : f.surface)
    EXPECT_GT(std::abs(std::atan2(s.position.y(), s.position.x())), 0.2 + 3 * 2 * std::numbers::pi / 1024);
}

TEST(Features, RockGrazedByTheBeamsIsNotUsed) {
  // A wall 1 m to the left along x: seen at less than 10 degrees beyond 5.7 m.
  const auto range = [](double a) { return a > 0.02 && a < 3.12 ? 1 / std::sin(a) : std::nan(""); };
  const Features f = find_features(ring(range), {}, 1);
  ASSERT_FALSE(f.surface.empty());
  for (const Feature& s : f.surface) EXPECT_LT(std::abs(s.position.x()), 1 / std::tan(0.17) + 0.3);
}

TEST(Features, NoiseOfRangesMakesNoEdges) {
  Random random(3);
  const Features f = find_features(ring([&](double a) { return square(a) + 0.02 * random.normal(); }), {}, 1);
  for (const Feature& e : f.edges)
    EXPECT_LT((e.position.cast<double>().cwiseAbs() - Vec3(5, 5, 0)).norm(), 0.3);
}

TEST(Features, AreTheSameForAnyNumberOfThreads) {
  const Sweep sweep = sweep_of(furnished_room(), lidar(32, 512), standing_at({}), kSecond, 0.02);
  const FeatureOptions o;
  const Features one = find_features(sweep.points, o, 1);
  EXPECT_GT(one.planes.size(), 500u);
  for (const int threads : {2, 4}) {
    const Features more = find_features(sweep.points, o, threads);
    const auto same = [](const std::vector<Feature>& a, const std::vector<Feature>& b) {
      return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Feature)) == 0;
    };
    EXPECT_TRUE(same(one.edges, more.edges) && same(one.planes, more.planes) &&
                same(one.surface, more.surface));
  }
}

RC_GTEST_PROP(Features, AnyFinitePointsGiveFiniteFeaturesOutOfTheirMidst, ()) {
  const auto count = *rc::gen::inRange<std::size_t>(0, 300);
  std::vector<SweepPoint> points;
  for (std::size_t i = 0; i < count; ++i) {
    const auto number = [] { return 0.01f * static_cast<float>(*rc::gen::inRange(-2000, 2000)); };
    points.push_back({{number(), number(), number()}, -0.05f, static_cast<std::uint16_t>(i / 100), 0});
    if (points.back().position.norm() < 0.02f) points.back().position.x() = 1;
  }
  const Features f = find_features(points, {}, 1);
  RC_ASSERT(f.surface.size() <= points.size());
  for (const auto* list : {&f.edges, &f.planes, &f.surface})
    for (const Feature& x : *list) {
      const auto same = [&](const SweepPoint& p) { return p.position == x.position; };
      RC_ASSERT(std::any_of(points.begin(), points.end(), same));
    }
}

}  // namespace
