// Normals point into the air: of shapes whose air is known.
#include "sdk/cave_from_cloud/orient.h"

#include <gtest/gtest.h>

#include <set>

#include "sdk/cave_from_cloud/signed_sets.h"
#include "sdk/cave_from_cloud/thin_out.h"
#include "tests/unit/cave_from_cloud/scans.h"

namespace karst::from_cloud {
namespace {

using core::PointTree;
using core::Random;
using core::Vec3;
using core::Vec3f;

constexpr double kSpacing_m = 0.15;

struct Oriented {
  std::vector<Vec3f> points, normals;
  Orientation orientation;
  double agreement = 0;
};

Oriented oriented(const std::vector<Vec3>& scan, const std::vector<Vec3>& views,
                  double spacing = kSpacing_m) {
  Oriented o;
  o.points = thinned(test::cloud_of(scan), spacing).points;
  const PointTree tree(o.points);
  const Neighbours neighbours(tree, 12);
  o.normals = plane_normals(o.points, neighbours);
  Random random(1);
  for (Vec3f& n : o.normals)
    if (random.uniform() < 0.5) n = -n;
  o.orientation = orient(tree, neighbours, views, spacing, o.normals);
  o.agreement = agreement(o.normals, neighbours);
  return o;
}

/// Share of the normals that point to where the distance to the wall, negative in the air, is less.
template <class ToWall>
double share_into_air(const Oriented& o, const ToWall& to_wall) {
  std::size_t good = 0;
  for (std::size_t i = 0; i < o.points.size(); ++i) {
    const Vec3 p = o.points[i].cast<double>(), n = o.normals[i].cast<double>();
    EXPECT_NEAR(n.norm(), 1, 1e-5);
    if (to_wall(p + kSpacing_m * n) < to_wall(p - kSpacing_m * n)) ++good;
  }
  return static_cast<double>(good) / static_cast<double>(o.points.size());
}

TEST(Orient, WithoutViewsTheVoteOfRaysFindsTheAir) {
  const Oriented o = oriented(test::scan_of_hall_and_passage({.entrance = true}), {});
  EXPECT_GT(share_into_air(o, test::to_wall), 0.998);
  EXPECT_GT(o.agreement, 0.998);
  EXPECT_EQ(o.orientation.seen, 0u);
  EXPECT_GT(o.orientation.rays, o.points.size() / 2);
  EXPECT_GT(static_cast<double>(o.orientation.agreed), 0.95 * static_cast<double>(o.orientation.rays));
}

TEST(Orient, EachOfTwoCavesHasItsOwnVote) {
  std::vector<Vec3> scan = test::scan_of_hall_and_passage({});
  const Vec3 apart(0, 40, 0);
  for (const Vec3& p : test::scan_of_hall_and_passage({.origin = apart}, 9)) scan.push_back(p);
  const Oriented o = oriented(scan, {});
  EXPECT_GT(
      share_into_air(o, [&](const Vec3& p) { return std::min(test::to_wall(p), test::to_wall(p - apart)); }),
      0.998);
}

TEST(Orient, ViewsDecideWhereTheySeeAndTheSignPassesOn) {
  // From its place in the hall, the scanner sees little of the passage.
  const Oriented o = oriented(test::scan_of_hall_and_passage({.entrance = true}), {Vec3(-1, 0, 0)});
  EXPECT_GT(o.orientation.seen, o.points.size() * 2 / 5);
  EXPECT_LT(o.orientation.seen, o.points.size() * 4 / 5);
  EXPECT_EQ(o.orientation.rays, 0u) << "nothing is left to vote on";
  EXPECT_GT(share_into_air(o, test::to_wall), 0.998);
}

// Seen from outside, the same ball has its air outside.
TEST(Orient, ViewsOverruleWhatRaysWouldSay) {
  Random random(6);
  std::vector<Vec3> ball, views;
  for (int i = 0; i < 60000; ++i) ball.push_back(2 * test::random_unit(random));
  for (int i = 0; i < 40; ++i) views.push_back(6 * test::random_unit(random));
  const Oriented o = oriented(ball, views);
  EXPECT_EQ(share_into_air(o, [](const Vec3& p) { return 2 - p.norm(); }), 1);
}

// A passage 0.6 m behind the wall: the nearest view of many of its points stands in the other passage.
TEST(Orient, AViewDoesNotSeeThroughAThinWall) {
  const auto to_wall = [](const Vec3& p) {
    const Vec3 near(std::clamp(p.x(), 0.0, 15.0), 0, 0), far = near + Vec3(0, 2.6, 0);
    return std::min((p - near).norm(), (p - far).norm()) - 1;
  };
  Random random(2);
  std::vector<Vec3> scan;
  for (int i = 0; i < 100000; ++i) {
    const double a = random.uniform(0, 2 * std::numbers::pi);
    scan.emplace_back(random.uniform(0, 15), std::cos(a) + (i % 2 == 0 ? 0 : 2.6), std::sin(a));
  }
  const Oriented o = oriented(scan, {Vec3(2, 0, 0), Vec3(7, 0, 0), Vec3(12, 0, 0), Vec3(7, 2.6, 0)});
  EXPECT_GT(o.orientation.seen, o.points.size() / 4);
  EXPECT_GT(share_into_air(o, to_wall), 0.99);
}

TEST(Normals, OfAPlaneAreItsOwn) {
  std::vector<Vec3f> points;
  Random random(3);
  const Vec3 across = test::random_unit(random), u = across.unitOrthogonal(), v = across.cross(u);
  for (int i = 0; i < 500; ++i)
    points.push_back((random.uniform(-2, 2) * u + random.uniform(-2, 2) * v).cast<float>());
  const PointTree tree(points);
  for (const Vec3f& n : plane_normals(points, Neighbours(tree, 12)))
    EXPECT_NEAR(std::abs(n.cast<double>().dot(across)), 1, 1e-5);
}

TEST(Normals, AgreementIsOneOfEqualNormalsAndAboutAHalfOfRandomOnes) {
  std::vector<Vec3f> points, normals;
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    points.push_back((5 * test::random_unit(random)).cast<float>());
    normals.emplace_back(0, 0, random.uniform() < 0.5 ? 1 : -1);
  }
  const PointTree tree(points);
  const Neighbours neighbours(tree, 5);
  EXPECT_NEAR(agreement(normals, neighbours), 0.5, 0.05);
  for (Vec3f& n : normals) n = Vec3f(0, 0, -1);
  EXPECT_EQ(agreement(normals, neighbours), 1);
}

/// Sets that are relabelled at each union.
TEST(SignedSets, KnowSetsAndSignsAsBruteForceDoes) {
  constexpr std::uint32_t kMembers = 40;
  Random random(11);
  SignedSets sets(kMembers);
  std::vector<std::uint32_t> set(kMembers);
  std::vector<bool> sign(kMembers, false);
  for (std::uint32_t i = 0; i < kMembers; ++i) set[i] = i;
  for (int step = 0; step < 60; ++step) {
    const auto a = static_cast<std::uint32_t>(random.uniform(0, kMembers)),
               b = static_cast<std::uint32_t>(random.uniform(0, kMembers));
    const bool differ = random.uniform() < 0.5, together = set[a] == set[b];
    EXPECT_EQ(sets.unite(a, b, differ), !together);
    if (!together) {
      const bool turn = (sign[a] != sign[b]) != differ;
      const std::uint32_t old = set[b];
      for (std::uint32_t i = 0; i < kMembers; ++i)
        if (set[i] == old) {
          set[i] = set[a];
          sign[i] = sign[i] != turn;
        }
    }
    for (std::uint32_t i = 0; i < kMembers; ++i) {
      EXPECT_EQ(sets.size_of_set(i), static_cast<std::size_t>(std::count(set.begin(), set.end(), set[i])));
      for (std::uint32_t j = 0; j < i; ++j) {
        const SignedSets::Root r = sets.root(i), s = sets.root(j);
        ASSERT_EQ(r.index == s.index, set[i] == set[j]);
        if (r.index == s.index) {
          ASSERT_EQ(r.differs == s.differs, sign[i] == sign[j]);
        }
      }
    }
  }
}

}  // namespace
}  // namespace karst::from_cloud
