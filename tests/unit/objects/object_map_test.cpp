#include "core_stack/objects/object_map.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "core_stack/common/random.h"

namespace karst::core {
namespace {

/// How the detector would report an object that truly lies at `place`, seen from `T_world_camera`.
ObjectDetection seen(ObjectKind kind, const Vec3& place, const Pose& T_world_camera,
                     double range_sigma_m = 0.1) {
  const Vec3 p = T_world_camera.inverse() * place;
  ObjectDetection d;
  d.kind = kind, d.direction = p.normalized(), d.range_m = p.norm();
  d.bearing_sigma_rad = 0.02, d.range_sigma_m = range_sigma_m, d.confidence = 0.9;
  return d;
}

ObjectDetections look(double t_s, std::vector<ObjectDetection> found) {
  return {from_seconds(t_s), nullptr, std::move(found)};
}

RC_GTEST_PROP(ObjectMap, HasTheWeightedLeastSquaresOfAllSightings, (std::uint64_t seed)) {
  Random random(seed);
  const Vec3 truth(random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-5, 5));
  ObjectMap map({});
  // Normal equations over all sightings at once.
  Mat3 N = Mat3::Zero();
  Vec3 b = Vec3::Zero();
  const int looks = 3 + static_cast<int>(random.uniform() * 20);
  for (int i = 0; i < looks; ++i) {
    const Vec3 eye = truth + Vec3(random.uniform(1, 4), random.uniform(-3, 3), random.uniform(-2, 2));
    const Pose T{eye, Quat(Eigen::AngleAxisd(random.uniform(-3, 3),
                                             Vec3(random.normal(), random.normal(), 1).normalized()))};
    const Vec3 noise = 0.05 * Vec3(random.normal(), random.normal(), random.normal());
    const ObjectDetection d = seen(ObjectKind::helmet, truth + noise, T, random.uniform(0.05, 0.4));
    map.note(look(0.2 * i, {d}), T, 0);
    const Sighting s = locate(d, T);
    N += s.covariance.inverse();
    b += s.covariance.inverse() * s.position;
  }
  const auto found = map.objects();
  RC_ASSERT(found.size() == 1u);
  RC_ASSERT(found[0].sightings == static_cast<std::uint32_t>(looks));
  RC_ASSERT((found[0].position - N.ldlt().solve(b)).norm() < 1e-9);
  RC_ASSERT(std::abs(found[0].deviation_m - std::sqrt(N.inverse().trace())) < 1e-9);
}

TEST(ObjectMap, TellsADeviationThatHolds) {
  // The squared error over the squared deviation is 1 in the mean if the deviation is honest.
  Random random(17);
  double sum = 0;
  constexpr int kObjects = 400;
  for (int k = 0; k < kObjects; ++k) {
    const Vec3 truth(10, 3, 0), own_error = 0.2 * Vec3(random.normal(), random.normal(), random.normal());
    ObjectMap map({});
    for (int i = 0; i < 12; ++i) {
      const Pose T{{8 + 0.2 * i, 1, 1}, Quat(Eigen::AngleAxisd(0.9, Vec3::UnitZ()))};
      ObjectDetection d = seen(ObjectKind::lamp, truth, T, 0.15);
      const Vec3 side = d.direction.cross(Vec3::UnitZ()).normalized(), up = side.cross(d.direction);
      d.direction = (d.direction + 0.02 * random.normal() * side + 0.02 * random.normal() * up).normalized();
      d.range_m += 0.15 * random.normal();
      map.note(look(0.2 * i, {d}), {T.position + own_error, T.orientation}, 0.2);
    }
    const FoundObject o = map.objects().at(0);
    sum += (o.position - truth).squaredNorm() / (o.deviation_m * o.deviation_m);
  }
  EXPECT_NEAR(sum / kObjects, 1, 0.15);  // four deviations of the mean of 400 chi squares
}

TEST(ObjectMap, ConfirmsAfterAsManySightingsAsAskedFor) {
  ObjectOptions o;
  o.confirm_after = 4;
  ObjectMap map(o);
  for (int i = 1; i <= 4; ++i) {
    map.note(look(i, {seen(ObjectKind::rope, {3, 0, 0}, {})}), {}, 0);
    EXPECT_EQ(map.objects().size(), i < 4 ? 0u : 1u) << i;
    EXPECT_EQ(map.take_news(from_seconds(i)).size(), i < 4 ? 0u : 1u) << i;
  }
}

TEST(ObjectMap, ForgetsWhatWasSeenOnceAndNeverAgain) {
  ObjectMap map({});
  map.note(look(0, {seen(ObjectKind::rope, {3, 0, 0}, {})}), {}, 0);
  map.note(look(1, {seen(ObjectKind::rope, {3, 0, 0}, {})}), {}, 0);
  map.note(look(62, {}), {}, 0);
  map.note(look(63, {seen(ObjectKind::rope, {3, 0, 0}, {})}), {}, 0);
  EXPECT_TRUE(map.objects().empty()) << "the two sightings of a minute ago no longer count";
}

TEST(ObjectMap, TellsKindsAndPlacesApart) {
  ObjectMap map({});
  for (int i = 0; i < 5; ++i)
    map.note(look(i, {seen(ObjectKind::rope, {3, 0, 0}, {}), seen(ObjectKind::drill, {3, 0, 0}, {}),
                      seen(ObjectKind::rope, {3, 2.5, 0}, {})}),
             {}, 0);
  const auto found = map.objects();
  ASSERT_EQ(found.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(found[i].number, i + 1);
}

TEST(ObjectMap, TakesTwoInOneImageForTwoThoughTheyAreNear) {
  ObjectMap map({});
  for (int i = 0; i < 8; ++i)
    map.note(look(i, {seen(ObjectKind::rope, {3, 0, 0}, {}), seen(ObjectKind::rope, {3, 0.6, 0}, {})}), {},
             0);
  const auto found = map.objects();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR((found[0].position - found[1].position).norm(), 0.6, 1e-6);
}

TEST(ObjectMap, MergesWhatComesToLieAtOnePlaceAndTakesOneBack) {
  ObjectMap map({});
  // A camera that knows ranges badly puts one object at two places, 2 m apart along its sight ...
  for (int i = 0; i < 3; ++i) map.note(look(i, {seen(ObjectKind::phone, {4, 0, 0}, {}, 0.05)}), {}, 0);
  for (int i = 3; i < 6; ++i) map.note(look(i, {seen(ObjectKind::phone, {6, 0, 0}, {}, 0.2)}), {}, 0);
  ASSERT_EQ(map.objects().size(), 2u);
  ASSERT_EQ(map.take_news(from_seconds(6)).size(), 2u);
  // ... and from the side the second turns out to lie where the first is.
  const Pose side{{5, -4, 0}, Quat(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ()))};
  for (int i = 7; i < 60 && map.objects().size() > 1; ++i)
    map.note(look(i, {seen(ObjectKind::phone, {4.6 + 1.2 * std::exp(-0.3 * (i - 7)), 0, 0}, side, 0.05)}),
             side, 0);
  const auto found = map.objects();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].number, 1u) << "the lower number was told first and stays";
  bool withdrawn = false;
  for (const ObjectNews& n : map.take_news(from_seconds(60)))
    withdrawn = withdrawn || (n.state == ObjectState::withdrawn && n.object.number == 2);
  EXPECT_TRUE(withdrawn);
}

TEST(ObjectMap, TellsAgainWhatItKnowsMuchBetterButNotAllTheTime) {
  ObjectMap map({});
  const auto sight = [&](double t_s, double range_sigma_m) {
    map.note(look(t_s, {seen(ObjectKind::person, {4, 0, 0}, {}, range_sigma_m)}), {}, 0);
    return map.take_news(from_seconds(t_s));
  };
  sight(0, 1), sight(1, 1);
  auto news = sight(2, 1);
  ASSERT_EQ(news.size(), 1u);
  EXPECT_EQ(news[0].state, ObjectState::found);
  EXPECT_TRUE(sight(3, 0.05).empty()) << "told a second ago";
  news = sight(7.5, 0.05);
  ASSERT_EQ(news.size(), 1u);
  EXPECT_EQ(news[0].state, ObjectState::revised);
  EXPECT_TRUE(sight(20, 0.05).empty()) << "hardly better than what was told";
  EXPECT_EQ(map.take_news(from_seconds(21), true).size(), 1u) << "but at the end it is told";
  EXPECT_TRUE(map.take_news(from_seconds(22), true).empty());
}

TEST(ObjectMap, IsNotSpoiledByNonsense) {
  ObjectMap map({});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 5; ++i) {
    std::vector<ObjectDetection> bad(8, seen(ObjectKind::rope, {3, 0, 0}, {}));
    bad[0].range_m = nan;
    bad[1].range_m = -1;
    bad[2].direction.x() = nan;
    bad[3].kind = ObjectKind::none;
    bad[4].confidence = 0.1;
    bad[5].range_m = std::numeric_limits<double>::infinity();
    bad[6].range_sigma_m = nan;
    bad[7].bearing_sigma_rad = nan;
    map.note(look(i, bad), {}, 0);
  }
  EXPECT_TRUE(map.objects().empty());
}

}  // namespace
}  // namespace karst::core
