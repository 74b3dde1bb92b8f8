// The executive in real time, by a clock that only sleeping and the test's own steps move: nothing here
// depends on how fast the machine is.
#include <gtest/gtest.h>

#include <algorithm>
#include <future>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>

#include "core_stack/common/executive.h"

namespace karst::core {
namespace {

const auto kNever = [] { return false; };

class FakeClock final : public WallClock {
 public:
  TimeNs now() const override { return now_; }
  void sleep_until(TimeNs time) const override { now_ = std::max(now_, time); }
  void pass(TimeNs duration) { now_ += duration; }

 private:
  mutable TimeNs now_ = 12345 * kSecond;  // from any origin
};

struct RealTime : testing::Test {
  FakeClock clock;
  Executive executive{1, Clock::real_time, {.clock = &clock}};
};

TEST_F(RealTime, StepsThatComeWhenTheyAreDueAreNotLate) {
  executive.every("control", 10 * kMillisecond, 10 * kMillisecond, [] {});
  executive.run_until(kSecond, kNever);
  const Punctuality& p = executive.punctuality().at("control");
  EXPECT_EQ(p.lateness.count(), 100u);
  EXPECT_EQ(p.lateness.max(), 0);
  EXPECT_EQ(p.missed_deadlines, 0u);
  EXPECT_EQ(executive.overruns(), 0);
}

TEST_F(RealTime, TheLatenessOfAStepIsFromWhenItWasDueToWhenItBegan) {
  executive.every("long", 0, 100 * kMillisecond, [&] { clock.pass(25 * kMillisecond); });
  executive.every("control", 10 * kMillisecond, 10 * kMillisecond, [] {});
  executive.run_until(95 * kMillisecond, kNever);
  const Punctuality& p = executive.punctuality().at("control");
  // Due at 10, 20, 30, ...; the loop is free again at 25: late by 15 and by 5 ms.
  EXPECT_EQ(p.lateness.count(), 9u);
  EXPECT_EQ(p.lateness.max(), 15 * kMillisecond);
  EXPECT_EQ(p.lateness.quantile(7.0 / 9), 0) << "the other seven are on time";
  EXPECT_NEAR(seconds(p.lateness.quantile(8.0 / 9)), 0.005, 0.005 / 32);
  EXPECT_EQ(executive.costs().at("control").overruns, 1);
  EXPECT_EQ(p.missed_deadlines, 1u) << "the one due at 10 ended at 25";
}

TEST_F(RealTime, AStepThatTakesAPeriodItselfMissesItsDeadline) {
  int n = 0;
  executive.every("control", 10 * kMillisecond, 10 * kMillisecond, [&] {
    if (++n == 3) clock.pass(10 * kMillisecond);
  });
  executive.run_until(95 * kMillisecond, kNever);
  EXPECT_EQ(executive.punctuality().at("control").missed_deadlines, 1u);
}

TEST_F(RealTime, ALaneIsAsLateAsItsOldestJobIsBeyondItsBudget) {
  std::promise<void> finish;
  const std::shared_future<void> finished = finish.get_future().share();
  bool published = false;
  executive.at(0, [&] {
    executive.job(
        "mapping", Lane::map, 60 * kMillisecond, [finished] { finished.wait(); }, [&] { published = true; });
  });
  executive.every("tick", kMillisecond, kMillisecond, [] {});
  executive.run_until(60 * kMillisecond, kNever);
  EXPECT_EQ(executive.take_lateness(Lane::map), 0);
  executive.run_until(160 * kMillisecond, kNever);
  EXPECT_EQ(executive.take_lateness(Lane::map), 100 * kMillisecond);
  EXPECT_EQ(executive.take_lateness(Lane::localization), 0) << "another lane";
  executive.run_until(200 * kMillisecond, kNever);
  finish.set_value();
  executive.run_until(100 * kSecond, [&] { return published; });
  ASSERT_TRUE(published);
  EXPECT_GE(executive.take_lateness(Lane::map), 140 * kMillisecond)
      << "what was late and is done counts once";
  EXPECT_EQ(executive.take_lateness(Lane::map), 0);
}

TEST_F(RealTime, TheTimeOfAStepThatThrowsIsLatenessOfTheNext) {
  executive.at(5 * kMillisecond, [&] {
    clock.pass(30 * kMillisecond);
    throw std::runtime_error("it fails");
  });
  executive.every("control", 10 * kMillisecond, 10 * kMillisecond, [] {});
  EXPECT_THROW(executive.run_until(kSecond, kNever), std::runtime_error);
  executive.run_until(kSecond, kNever);
  EXPECT_EQ(executive.punctuality().at("control").lateness.max(), 25 * kMillisecond)
      << "due at 10, begun at 35";
}

TEST_F(RealTime, ALoopThatIsFarBehindSetsItsClockBack) {
  int ticks = 0;
  executive.every("tick", 10 * kMillisecond, 10 * kMillisecond, [&] {
    if (++ticks == 5) clock.pass(7 * kSecond);
  });
  executive.run_until(kSecond, kNever);
  EXPECT_EQ(ticks, 100) << "none is left out";
  EXPECT_EQ(executive.lost_time(), 7 * kSecond);
  EXPECT_EQ(executive.punctuality().at("tick").lateness.max(), 0)
      << "those after it are due by the new clock";
  EXPECT_EQ(executive.punctuality().at("tick").missed_deadlines, 1u);
}

TEST_F(RealTime, ALoopThatIsALittleBehindCatchesUp) {
  int ticks = 0;
  executive.every("tick", 10 * kMillisecond, 10 * kMillisecond, [&] {
    if (++ticks == 5) clock.pass(900 * kMillisecond);
  });
  executive.run_until(2 * kSecond, kNever);
  EXPECT_EQ(ticks, 200);
  EXPECT_EQ(executive.lost_time(), 0);
}

TEST(RealTimeThreads, EachLaneIsSetUpOnItsOwnThreadBeforeItsFirstJob) {
  std::mutex mutex;
  std::set<Lane> lanes;
  std::set<std::thread::id> threads;
  {
    Executive executive(1, Clock::real_time, {.on_lane_thread = [&](Lane lane) {
                          const std::lock_guard lock(mutex);
                          lanes.insert(lane);
                          threads.insert(std::this_thread::get_id());
                        }});
  }
  EXPECT_EQ(lanes,
            (std::set{Lane::sensing, Lane::localization, Lane::map, Lane::pictures, Lane::registration}));
  EXPECT_EQ(threads.size(), 5u);
  EXPECT_EQ(threads.count(std::this_thread::get_id()), 0u);
}

TEST(RealTimeThreads, InLockstepNothingIsLateHoweverLongItTakes) {
  FakeClock clock;
  Executive executive(2, Clock::lockstep, {.clock = &clock});
  executive.every("control", 10, 10, [&] {
    clock.pass(kSecond);
    executive.job(
        "mapping", Lane::map, 5, [] { std::this_thread::sleep_for(std::chrono::microseconds(200)); }, [] {});
  });
  executive.run_until(100, kNever);
  EXPECT_EQ(executive.take_lateness(Lane::map), 0);
  EXPECT_TRUE(executive.punctuality().empty());
  EXPECT_EQ(executive.lost_time(), 0);
}

}  // namespace
}  // namespace karst::core
