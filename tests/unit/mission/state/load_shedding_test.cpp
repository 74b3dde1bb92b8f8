#include "core_stack/mission/state/load_shedding.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core_stack/common/random.h"

namespace karst::core {
namespace {

constexpr TimeNs kPeriod = 100 * kMillisecond, kTolerated = 300 * kMillisecond;
const std::vector<Relief> kReliefs{Relief::half_the_scans, Relief::quarter_the_scans,
                                   Relief::fewer_decisions};

struct Lane1 {
  LaneLoad load{kReliefs, kTolerated};
  TimeNs now = 0;
  std::vector<LaneLoad::Change> changes;
  void behind(TimeNs lateness, double for_s) {
    for (const TimeNs end = now + from_seconds(for_s); now < end;) {
      now += kPeriod;
      if (const auto change = load.observe(now, lateness)) changes.push_back(*change);
    }
  }
};

TEST(LaneLoad, ALaneThatKeepsUpIsNeverRelieved) {
  Lane1 lane;
  lane.behind(kTolerated, 100);
  EXPECT_TRUE(lane.changes.empty());
  for (const Relief r : kReliefs) EXPECT_FALSE(lane.load.sheds(r));
}

TEST(LaneLoad, OneReliefASecondInOrderAndNoMoreThanThereAre) {
  Lane1 lane;
  lane.behind(2 * kTolerated, 10);
  ASSERT_EQ(lane.changes.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(lane.changes[i].relief, kReliefs[i]);
    EXPECT_TRUE(lane.changes[i].begins);
    EXPECT_EQ(lane.changes[i].since, static_cast<TimeNs>(i + 1) * kSecond);
    EXPECT_EQ(lane.changes[i].behind, 2 * kTolerated);
    EXPECT_TRUE(lane.load.sheds(kReliefs[i]));
  }
}

TEST(LaneLoad, ASingleLateJobIsNoReason) {
  Lane1 lane;
  for (int i = 0; i < 100; ++i) {
    lane.behind(kSecond, 0.3);  // a decision now and then
    lane.behind(0, 0.7);
  }
  EXPECT_TRUE(lane.changes.empty());
}

TEST(LaneLoad, TakesReliefsBackTheLastFirstWhenThereWasRoomForFiveSeconds) {
  Lane1 lane;
  lane.behind(kSecond, 2);
  ASSERT_EQ(lane.changes.size(), 2u);
  lane.behind(0, 4.9);
  EXPECT_EQ(lane.changes.size(), 2u) << "not yet";
  lane.behind(0, 30);
  ASSERT_EQ(lane.changes.size(), 4u);
  EXPECT_EQ(lane.changes[2].relief, Relief::quarter_the_scans);
  EXPECT_FALSE(lane.changes[2].begins);
  EXPECT_EQ(lane.changes[2].since, 2 * kSecond) << "since when it had been in force";
  EXPECT_EQ(lane.changes[3].relief, Relief::half_the_scans);
  EXPECT_FALSE(lane.load.sheds(Relief::half_the_scans));
}

// A lane that only keeps up with the relief would be relieved and loaded again for ever.
TEST(LaneLoad, AReliefThatIsNeededAgainAtOnceStaysLongerEachTime) {
  Lane1 lane;
  std::vector<double> held_s;
  for (int i = 0; i < 3000; ++i) {
    const bool relieved = lane.load.sheds(Relief::half_the_scans);
    lane.behind(relieved ? 0 : kSecond, 0.1);
  }
  for (const LaneLoad::Change& c : lane.changes)
    if (c.begins) held_s.push_back(seconds(c.since));
  ASSERT_GT(held_s.size(), 4u);
  for (std::size_t i = 2; i + 1 < held_s.size(); ++i)
    EXPECT_GE(held_s[i + 1] - held_s[i], held_s[i] - held_s[i - 1] - 0.2);
  EXPECT_LE(lane.changes.size(), 16u) << "in five minutes";
}

TEST(LaneLoad, AReliefThatWasNotNeededForLongStaysAsShortAsTheFirst) {
  Lane1 lane;
  lane.behind(kSecond, 1);
  lane.behind(0, 60);
  lane.behind(kSecond, 1);
  lane.behind(0, 60);
  ASSERT_EQ(lane.changes.size(), 4u);
  EXPECT_FALSE(lane.changes[3].begins);
  lane.changes.clear();
  lane.behind(kSecond, 1);
  lane.behind(0, 5.1);
  EXPECT_EQ(lane.changes.size(), 2u);
}

// Whatever is observed: reliefs are taken in order, and given back in the opposite order.
TEST(LaneLoad, ReliefsAreAStack) {
  for (int seed = 1; seed <= 30; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    Lane1 lane;
    for (int i = 0; i < 200; ++i) lane.behind(random.uniform() < 0.4 ? kSecond : 0, random.uniform(0.1, 8));
    std::vector<Relief> in_force;
    for (const LaneLoad::Change& c : lane.changes) {
      if (c.begins) {
        ASSERT_LT(in_force.size(), kReliefs.size());
        EXPECT_EQ(c.relief, kReliefs[in_force.size()]);
        in_force.push_back(c.relief);
      } else {
        ASSERT_FALSE(in_force.empty());
        EXPECT_EQ(c.relief, in_force.back());
        in_force.pop_back();
      }
    }
    for (const Relief r : kReliefs)
      EXPECT_EQ(lane.load.sheds(r), std::find(in_force.begin(), in_force.end(), r) != in_force.end());
  }
}

std::vector<Relief> all_of(LoadShedding load) {
  std::vector<Relief> taken;
  for (TimeNs now = 0; now < 20 * kSecond; now += kPeriod)
    for (const auto& change : {load.observe_map(now, kSecond), load.observe_localization(now, kSecond)})
      if (change) taken.push_back(change->relief);
  std::sort(taken.begin(), taken.end());
  return taken;
}

TEST(LoadShedding, LeavesOutOnlyWhatTheVehicleHas) {
  using enum Relief;
  EXPECT_EQ(all_of(LoadShedding({})), std::vector{fewer_decisions});
  EXPECT_EQ(all_of(LoadShedding({.depth_images = true})), (std::vector{half_the_images, fewer_decisions}));
  EXPECT_EQ(all_of(LoadShedding(
                {.maps_scans = true, .locates_scans = true, .depth_images = true, .pictures = true})),
            (std::vector{half_the_scans, quarter_the_scans, half_the_images, fewer_decisions, no_pictures,
                         half_the_features, half_the_sweeps}));
}

TEST(LoadShedding, LocalizationIsRelievedByItselfAndCounted) {
  LoadShedding load({.maps_scans = true, .locates_scans = true});
  for (TimeNs now = 0; now < 3 * kSecond; now += kPeriod) {
    load.observe_map(now, 0);
    load.observe_localization(now, 100 * kMillisecond);
  }
  EXPECT_TRUE(load.sheds(Relief::half_the_features));
  EXPECT_FALSE(load.sheds(Relief::half_the_scans));
  EXPECT_EQ(load.times(Relief::half_the_features), 1);
  EXPECT_EQ(load.times(Relief::half_the_scans), 0);
}

}  // namespace
}  // namespace karst::core
