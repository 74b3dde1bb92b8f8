#include "core_stack/mission/decision/goal_ledger.h"

#include <gtest/gtest.h>

#include "tests/unit/mission/drawn_map.h"

namespace karst::core {
namespace {

TEST(GoalLedger, APlaceIsOpenUntilItIsClosed) {
  const VoxelMap map{MapOptions{}};
  GoalLedger ledger;
  EXPECT_FALSE(ledger.closed(map, Vec3(1, 2, 3), {.at = 0}));
  ledger.close(map, Vec3(1, 2, 3), 0, "tried");
  EXPECT_EQ(ledger.closed(map, Vec3(1, 2, 3), {.at = kSecond}), "tried");
  EXPECT_EQ(ledger.closed(map, Vec3(1.3, 2, 3), {.at = kSecond}), "tried")
      << "a step aside is the same place";
  EXPECT_FALSE(ledger.closed(map, Vec3(3, 2, 3), {.at = kSecond}));
}

TEST(GoalLedger, StaysClosedForeverWhileTheMapThereIsUnchanged) {
  VoxelMap map{MapOptions{}};
  GoalLedger ledger;
  ledger.close(map, Vec3::Zero(), 0, "tried");
  EXPECT_TRUE(ledger.closed(map, Vec3::Zero(), {.at = 100000 * kSecond}));
  EXPECT_TRUE(ledger.closed(map, Vec3::Zero(), {.at = 9 * kSecond, .ignore_map_change = true}));
  EXPECT_FALSE(ledger.closed(map, Vec3::Zero(), {.at = 11 * kSecond, .ignore_map_change = true}))
      << "judged by its pause alone";
  carve_box(map, Vec3(20, 20, 20), Vec3(22, 22, 22));  // far away
  EXPECT_TRUE(ledger.closed(map, Vec3::Zero(), {.at = 100000 * kSecond}));
}

TEST(GoalLedger, ReopensAfterThePauseWhenTheMapThereChanged) {
  VoxelMap map{MapOptions{}};
  GoalLedger ledger;
  ledger.close(map, Vec3::Zero(), 0, "tried");
  carve_box(map, Vec3(-1, -1, -1), Vec3(1, 1, 1));
  EXPECT_TRUE(ledger.closed(map, Vec3::Zero(), {.at = 9 * kSecond}));
  EXPECT_FALSE(ledger.closed(map, Vec3::Zero(), {.at = 11 * kSecond}));
}

TEST(GoalLedger, APlaceThatCannotBeFlownToFromHereIsOpenAgainSoonWhateverTheMap) {
  const VoxelMap map{MapOptions{}};
  GoalLedger ledger;
  ledger.pause(map, Vec3::Zero(), 0, "too steep");
  EXPECT_EQ(ledger.closed(map, Vec3::Zero(), {.at = kSecond}), "too steep");
  EXPECT_FALSE(ledger.closed(map, Vec3::Zero(), {.at = 3 * kSecond}));
  ledger.close(map, Vec3::Zero(), 0, "tried");
  EXPECT_TRUE(ledger.closed(map, Vec3::Zero(), {.at = 9 * kSecond})) << "the first pause of a failure";
}

TEST(GoalLedger, AfterFourPausesAPlaceIsClosed) {
  const VoxelMap map{MapOptions{}};
  GoalLedger ledger;
  for (int i = 0; i < 4; ++i) ledger.pause(map, Vec3::Zero(), 0, "too steep");
  EXPECT_FALSE(ledger.closed(map, Vec3::Zero(), {.at = 3 * kSecond}));
  ledger.pause(map, Vec3::Zero(), 0, "too steep");
  EXPECT_TRUE(ledger.closed(map, Vec3::Zero(), {.at = 100000 * kSecond})) << "while the map is the same";
}

TEST(GoalLedger, ThePauseDoublesWithEveryAttempt) {
  VoxelMap map{MapOptions{}};
  GoalLedger ledger;
  ledger.close(map, Vec3::Zero(), 0, "first");
  ledger.close(map, Vec3::Zero(), 0, "second");
  carve_box(map, Vec3(-1, -1, -1), Vec3(1, 1, 1));
  EXPECT_EQ(ledger.closed(map, Vec3::Zero(), {.at = 19 * kSecond}), "second");
  EXPECT_FALSE(ledger.closed(map, Vec3::Zero(), {.at = 21 * kSecond}));
}

}  // namespace
}  // namespace karst::core
