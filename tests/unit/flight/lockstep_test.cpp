// The loop on vehicles that only stand there until they report that they are lost.
#include "sdk/flight/lockstep.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <stdexcept>
#include <thread>

namespace karst::flight {
namespace {

using core::kMillisecond;
using core::kSecond;
using core::TimeNs;

class LostVehicle final : public core::Vehicle {
 public:
  explicit LostVehicle(TimeNs lost_after) : lost_after_(lost_after) {}
  core::VehicleDescription description() const override { return {}; }
  void start(core::Executive& executive, core::VehicleSink& sink) override {
    executive.at(lost_after_,
                 [&sink, t = lost_after_] { sink.on_lost(t, core::MissionOutcome::contact, "hit a rock"); });
  }
  void command(const core::Command&) override {}

 private:
  TimeNs lost_after_;
};

class HoldingPolicy final : public core::PolicyPort {
 public:
  std::string name() const override { return "hold"; }
  core::Decision decide(const core::DecisionRequest&) override { return {}; }
  void notify(const core::PolicyEvent&) override {}
};

struct VehiclePlan {
  TimeNs starts_at = 0, lost_after = kSecond;
};

/// What the vehicles of a test fly with.
class Crew {
 public:
  explicit Crew(const std::vector<VehiclePlan>& plans) {
    const std::string test = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    for (const VehiclePlan& plan : plans) {
      const auto folder = std::filesystem::path(KARST_BINARY_DIR) / "test_runs" / "lockstep" / test /
                          std::to_string(vehicles_.size());
      std::filesystem::remove_all(folder);
      std::filesystem::create_directories(folder);
      core::Recorder& recorder = recorders_.emplace_back(folder);
      core::Vehicle& vehicle = vehicles_.emplace_back(plan.lost_after);
      seats_.push_back({&vehicle, &policy_, &recorder, nullptr, plan.starts_at});
    }
  }
  const std::vector<Seat>& seats() const { return seats_; }

 private:
  HoldingPolicy policy_;
  std::deque<core::Recorder> recorders_;
  std::deque<LostVehicle> vehicles_;
  std::vector<Seat> seats_;
};

/// Notes what happens between steps.
class NotingHooks final : public StepHooks {
 public:
  std::vector<std::string> notes;
  std::vector<TimeNs> exchanges;
  std::optional<TimeNs> fails_at;
  bool all_in_step = true;

  void on_start(std::size_t vehicle, TimeNs now) override { note("start", vehicle, now); }
  void exchange(Lockstep& flight, TimeNs now) override {
    exchanges.push_back(now);
    for (std::size_t i = 0; i < flight.size(); ++i)
      all_in_step &= !flight.state(i).flying || flight.state(i).ended ||
                     flight.executive(i).now() + flight.starts_at(i) == now;
    if (fails_at && now >= *fails_at) throw std::runtime_error("the world has failed");
  }
  void on_phase(const Lockstep& flight, std::size_t vehicle, TimeNs now) override {
    note(core::name_of(flight.state(vehicle).phase), vehicle, now);
  }
  void inject_faults(const Lockstep&, TimeNs) override {}

 private:
  void note(const std::string& what, std::size_t vehicle, TimeNs now) {
    notes.push_back(what + " " + std::to_string(vehicle) + " " + std::to_string(now / kMillisecond));
  }
};

bool watch_on(TimeNs, const std::vector<core::MissionStatus>&) { return true; }

TEST(Lockstep, OneVehicleAloneFliesToItsEnd) {
  const Crew crew({{0, 2050 * kMillisecond}});
  Lockstep flight({}, {}, crew.seats());
  std::vector<TimeNs> watched;
  const TimeNs end = flight.run([&](TimeNs now, const auto& all) {
    EXPECT_EQ(all.size(), 1u);
    watched.push_back(now);
    return true;
  });
  EXPECT_EQ(end, 2100 * kMillisecond) << "the end of the step in which it was lost";
  EXPECT_EQ(flight.state(0).ended->outcome, core::MissionOutcome::contact);
  EXPECT_EQ(flight.state(0).phase, core::Phase::done);
  EXPECT_EQ(watched, (std::vector<TimeNs>{kSecond, 2 * kSecond}));
}

TEST(Lockstep, InRealTimeOneVehicleFliesToItsEnd) {
  const Crew crew({{0, 50 * kMillisecond}});
  Lockstep flight({}, {.clock = core::Clock::real_time}, crew.seats());
  EXPECT_GE(flight.run(watch_on), 50 * kMillisecond);
  EXPECT_EQ(flight.state(0).ended->reason, "hit a rock");
}

/// From then on no step is due, and the map is written: whoever looks for signs of life must know.
TEST(Lockstep, InRealTimeItSaysThatItHasFlownBeforeTheRecordIsCompleted) {
  const Crew crew({{0, 50 * kMillisecond}});
  LockstepOptions how{.clock = core::Clock::real_time};
  int flown = 0;
  const Lockstep* flying = nullptr;
  how.real_time.on_landed = [&] {
    ++flown;
    EXPECT_FALSE(flying->state(0).ended);
    EXPECT_GE(flying->executive(0).now(), 50 * kMillisecond);
  };
  Lockstep flight({}, how, crew.seats());
  flying = &flight;
  flight.run(watch_on);
  EXPECT_EQ(flown, 1);
  EXPECT_TRUE(flight.state(0).ended);
}

/// Its loop does not return from a step.
class HangingVehicle final : public core::Vehicle {
 public:
  core::VehicleDescription description() const override { return {}; }
  void start(core::Executive& executive, core::VehicleSink&) override {
    executive.every("vehicle", 0, kSecond, [] {
      for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
    });
  }
  void command(const core::Command&) override {}
};

TEST(LockstepDeathTest, InRealTimeALoopThatHangsIsReportedByName) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto fly = [] {
    const Crew crew({VehiclePlan{}});
    HangingVehicle vehicle;
    std::vector<Seat> seats = crew.seats();
    seats.front().vehicle = &vehicle;
    LockstepOptions how{.clock = core::Clock::real_time};
    how.real_time.hang_limit = std::chrono::milliseconds(100);
    how.real_time.on_hang = [](const std::string& running) {
      std::fprintf(stderr, "%s hangs\n", running.c_str());
      std::_Exit(2);
    };
    Lockstep({}, how, seats).run(watch_on);
  };
  EXPECT_EXIT(fly(), testing::ExitedWithCode(2), "vehicle hangs");
}

std::vector<std::string> notes_of_three(int threads) {
  const Crew crew({{0, 1500 * kMillisecond}, {kSecond, kSecond}, {1200 * kMillisecond, 200 * kMillisecond}});
  NotingHooks hooks;
  Lockstep flight({}, {.threads = threads, .linger = 2 * kSecond}, crew.seats(), &hooks);
  EXPECT_EQ(flight.run(watch_on), 4 * kSecond) << "two seconds after the last is down";
  EXPECT_TRUE(hooks.all_in_step);
  EXPECT_EQ(hooks.exchanges.size(), 40u);
  for (std::size_t i = 0; i < hooks.exchanges.size(); ++i)
    EXPECT_EQ(hooks.exchanges[i], static_cast<TimeNs>(i + 1) * 100 * kMillisecond);
  return hooks.notes;
}

TEST(Lockstep, SeveralVehiclesStartInTurnAndStayInStepOnAnyNumberOfThreads) {
  const std::vector<std::string> expected = {"start 0 0",   "takeoff 0 1000", "start 1 1000", "start 2 1200",
                                             "done 2 1400", "done 0 1500",    "done 1 2000"};
  EXPECT_EQ(notes_of_three(1), expected);
  EXPECT_EQ(notes_of_three(3), expected);
}

TEST(Lockstep, WhenTheOperatorStopsItWhoWaitsDoesNotStart) {
  const Crew crew({{0, 5 * kSecond}, {3 * kSecond, kSecond}});
  NotingHooks hooks;
  Lockstep flight({}, {}, crew.seats(), &hooks);
  flight.run([](TimeNs now, const auto&) { return now < 2 * kSecond; });
  EXPECT_TRUE(flight.state(0).ended);
  EXPECT_FALSE(flight.state(1).ended);
  EXPECT_EQ(hooks.notes.front(), "start 0 0");
  for (const std::string& n : hooks.notes) EXPECT_NE(n, "start 1 3000");
}

TEST(Lockstep, WhenTheWorldFailsAllLand) {
  const Crew crew({{0, 5 * kSecond}, {kSecond, 4 * kSecond}, {3 * kSecond, kSecond}});
  NotingHooks hooks;
  hooks.fails_at = 2 * kSecond;
  Lockstep flight({}, {}, crew.seats(), &hooks);
  flight.run(watch_on);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_TRUE(flight.state(i).stopped) << i;
    EXPECT_TRUE(flight.state(i).ended) << i;
  }
  EXPECT_FALSE(flight.state(2).ended) << "it never started";
}

}  // namespace
}  // namespace karst::flight
