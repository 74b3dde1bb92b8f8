// The small records that parts of a mission keep: the way flown, how long it has been still, how long it can
// still fly.
#include <gtest/gtest.h>

#include "core_stack/mission/phases/endurance.h"
#include "core_stack/mission/phases/flown_path.h"
#include "core_stack/mission/phases/still_watch.h"

namespace karst::core {
namespace {

TEST(FlownPath, KeepsAPoseEveryQuarterOfAMetreAndItsLength) {
  FlownPath path;
  EXPECT_FALSE(path.begun());
  path.begin({0, 0, 1});
  for (int i = 1; i <= 1000; ++i) path.note({0.01 * i, 0, 1});
  EXPECT_NEAR(path.length_m(), 10, 0.3);
  EXPECT_NEAR(static_cast<double>(path.points().size()), 10 / 0.26 + 1, 1);
  for (std::size_t i = 1; i < path.points().size(); ++i)
    EXPECT_GT((path.points()[i] - path.points()[i - 1]).norm(), 0.25);
}

TEST(FlownPath, LeadsBackAPoseAMetreAsFarAsAskedAndToItsBeginning) {
  FlownPath path;
  path.begin({0, 0, 1});
  for (int i = 1; i <= 1000; ++i) path.note({0.01 * i, 0, 1});
  const auto near = path.back(3);
  EXPECT_EQ(near.front(), path.points().back());
  EXPECT_NEAR((near.front() - near.back()).norm(), 3, 0.6);
  for (std::size_t i = 1; i < near.size(); ++i) EXPECT_NEAR((near[i] - near[i - 1]).norm(), 1.04, 0.05);
  EXPECT_EQ(path.back(100).back(), Vec3(0, 0, 1)) << "it took off there";
  EXPECT_TRUE(path.back(0).empty());
  EXPECT_TRUE(FlownPath{}.back(5).empty());
}

TEST(StillWatch, CountsFromWhereItLastCameHalfAMetreAway) {
  StillWatch still;
  still.restart({0, 0, 0}, 0);
  EXPECT_EQ(still.still_for({0.4, 0, 0}, 5), 5);
  EXPECT_EQ(still.still_for({0.6, 0, 0}, 9), 0);
  EXPECT_EQ(still.still_for({0.2, 0, 0}, 12), 3) << "0.4 m from the new place";
  still.wait(20);
  EXPECT_EQ(still.still_for({0.6, 0, 0}, 21), 1);
}

TEST(Endurance, IsTheBatterysOrTheMissionsWhicheverEndsFirst) {
  Endurance e(100);
  EXPECT_EQ(e.seconds_left(0), 100);
  e.note({.fraction_left = 0.5, .seconds_left = 60});
  EXPECT_EQ(e.seconds_left(10 * kSecond), 60);
  EXPECT_EQ(e.seconds_left(70 * kSecond), 30);
  EXPECT_EQ(e.mission_seconds_left(10 * kSecond), 90);
  EXPECT_EQ(e.mission_seconds_left(70 * kSecond), 30);
}

}  // namespace
}  // namespace karst::core
