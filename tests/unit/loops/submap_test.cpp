#include "core_stack/loops/submap.h"

#include <gtest/gtest.h>

#include "core_stack/common/so3.h"
#include "tests/unit/loops/rough_passage.h"

namespace {

using namespace karst::core;
using karst::test::RoughPassage;

SubmapBuilder::Seen seen(TimeNs stamp, const Pose& pose, const std::vector<Vec3f>& points) {
  return {stamp, pose, true, 0, &points};
}

TEST(Submap, IsCutAtItsLengthAndChainsWithTheNext) {
  SubmapBuilder builder({.length_m = 4});
  const std::vector<Vec3f> points{{1, 2, 3}};
  std::vector<Submap> all;
  for (int i = 0; i <= 100; ++i)
    if (auto s = builder.add(seen(i * kSecond, {Vec3(0.1 * i, 0, 0), Quat::Identity()}, points)))
      all.push_back(*s);
  if (auto s = builder.finish()) all.push_back(*s);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].first, 0);
  EXPECT_EQ(all[1].first, 40 * kSecond);
  EXPECT_NEAR(all[1].path_begin_m, 4, 1e-9);
  EXPECT_NEAR(all[2].path_end_m, 10, 1e-9);
  EXPECT_NEAR(all[1].T_world_submap.position.x(), 4, 1e-9);
  EXPECT_FALSE(builder.finish());
}

TEST(Submap, OfAVehicleThatHoversHoldsOneSweep) {
  SubmapBuilder builder({});
  const std::vector<Vec3f> points(1000, Vec3f(1, 2, 3));
  for (int i = 0; i < 500; ++i)
    EXPECT_FALSE(builder.add(seen(i * kSecond, {Vec3(0.0001 * i, 0, 0), Quat::Identity()}, points)));
  const auto s = builder.finish();
  ASSERT_TRUE(s);
  EXPECT_EQ(s->flown.size(), 1u);
  EXPECT_EQ(s->packed.size(), 1u);
  EXPECT_EQ(s->last, 499 * kSecond);
}

TEST(Submap, KeepsPointsAndAttitudeInItsUprightFrame) {
  SubmapBuilder builder({});
  const Pose pose{Vec3(100, -50, 7), from_heading(1.2) * exp_so3({0.1, -0.2, 0})};
  const std::vector<Vec3f> points{{103, -50, 8}, {100, -44, 5}, {100, 50, 5}};
  builder.add(seen(1, pose, points));
  const auto s = builder.finish();
  ASSERT_TRUE(s);
  EXPECT_NEAR((s->T_world_submap.orientation * Vec3::UnitZ()).z(), 1, 1e-12);
  const Pose body = s->T_world_submap * s->T_submap_body;
  EXPECT_LT((body.position - pose.position).norm(), 1e-9);
  EXPECT_LT(body.orientation.angularDistance(pose.orientation), 1e-9);
  const std::vector<Vec3f> kept = s->points();
  ASSERT_EQ(kept.size(), 2u) << "the third point is out of range";
  for (const Vec3f& p : kept) {
    const Vec3 world = s->T_world_submap * p.cast<double>();
    double nearest = 1;
    for (const Vec3f& q : points) nearest = std::min(nearest, (world - q.cast<double>()).norm());
    EXPECT_LT(nearest, 0.01);
  }
}

TEST(Submap, SumsUpTheUncertaintyAndWhatWasNotObserved) {
  SubmapBuilder builder({});
  const std::vector<Vec3f> points{{1, 2, 3}};
  builder.add({0, {}, true, 0.5, &points});
  auto one = builder.add({1, {Vec3(5, 0, 0), Quat::Identity()}, false, 0.25, &points});
  ASSERT_TRUE(one);
  EXPECT_EQ(one->uncertainty_m, 0.5);
  EXPECT_TRUE(one->observed);
  const auto two = builder.finish();
  EXPECT_EQ(two->uncertainty_m, 0.75);
  EXPECT_FALSE(two->observed);
}

TEST(PackedPoints, AreWithinHalfACentimetreAndLoseWhatIsTooFar) {
  Random r(1);
  std::vector<Vec3f> points;
  for (int i = 0; i < 1000; ++i)
    points.emplace_back(Vec3(r.uniform(-300, 300), r.uniform(-20, 20), r.uniform(-9, 9)).cast<float>());
  Submap s;
  s.packed = packed(points);
  const auto out = s.points();
  ASSERT_EQ(out.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_LT((out[i] - points[i]).cwiseAbs().maxCoeff(), 0.0051f);
  EXPECT_TRUE(packed({{400, 0, 0}, {0, std::numeric_limits<float>::quiet_NaN(), 0}}).empty());
}

// Who flies along the other side of a passage, the other way, still finds the places alike.
TEST(Places, LookAlikeFromEitherSideOfThePassageAndInEitherDirection) {
  const RoughPassage passage(200, false, 0.25, 3);
  const auto places_at = [&](double s, double aside_m, double heading, std::uint64_t seed) {
    Random r(seed);
    const Pose T_world_submap{Vec3(s, aside_m, 0), from_heading(heading)};
    std::vector<Vec3f> points;
    for (const Vec3f& p : passage.rock(s, 15, r, 12'000))
      points.push_back((T_world_submap.inverse() * p.cast<double>()).cast<float>());
    return described_places(points, {Vec3f::Zero()}, {});
  };
  std::vector<std::vector<Place>> others;
  for (int k = 0; k < 10; ++k) others.push_back(places_at(30 + 12 * k, -0.7, 0.2, 2));
  int best_is_right = 0;
  for (int i = 0; i < 10; ++i) {
    const auto query = places_at(30 + 12 * i, 0.7, 3.1, 1);
    ASSERT_EQ(query.size(), 1u);
    float best = 0;
    int at = -1;
    double turn = 0;
    for (int k = 0; k < 10; ++k) {
      const auto& other = others[static_cast<std::size_t>(k)];
      const float likeness = other[0].descriptor.invariants().dot(query[0].descriptor.invariants());
      if (likeness <= best) continue;
      best = likeness, at = k;
      turn = other[0].descriptor.turn_of(query[0].descriptor).angle_rad;
    }
    best_is_right += at == i && std::abs(wrap_angle(turn - 2.9)) < 0.2;
  }
  EXPECT_GE(best_is_right, 8);
}

}  // namespace
