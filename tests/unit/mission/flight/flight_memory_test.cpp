// Out of memory the vehicle still has to come down: what flies it allocates none. A program of its own, for
// it counts every allocation.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "core_stack/mission/flight/flight.h"
#include "core_stack/team/communication/record_store.h"

namespace {
long allocations = 0;
long left = -1;  // that succeed from now on; negative: all
}  // namespace

// The other forms of new and delete come to these. Inlined, g++ sees only that free() ends what new began,
// and warns
// (-Wmismatched-new-delete).
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (left == 0) throw std::bad_alloc();
  if (left > 0) --left;
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace karst::core {
namespace {

/// A vehicle that is always where its reference says, as its sensors have it.
struct SensedFlight {
  VehicleDescription vehicle;
  Flight flight{CoreOptions{}, vehicle};
  TimeNs now = 0;

  /// Control at 100 Hz, the sensors at the simulator's rates.
  void advance(double s) {
    for (const TimeNs end = now + from_seconds(s); now < end;) {
      now += 5 * kMillisecond;
      flight.on_imu({now, Vec3(0, 0, 9.81), Vec3::Zero()}, now);
      if (now % (10 * kMillisecond) == 0) flight.control(now);
      if (now % (20 * kMillisecond) == 0) flight.on_magnetometer({now, Vec3(20, 0, -40)});
      if (now % (40 * kMillisecond) == 0) flight.on_barometer({now, 0});
      if (now % (100 * kMillisecond) == 0)
        flight.on_lidar_pose({now - 80 * kMillisecond, vehicle.T_world_start, 1e-4 * Matrix6::Identity()});
    }
  }
};

TEST(Flight, TakesNoMemoryInTheAirNorForTheEmergencyLanding) {
  SensedFlight f;
  f.flight.climb(0, 0.5, 0.5);
  f.advance(5);
  HeadingPlan heading;
  f.flight.follow({.points = {Vec3(0, 0, 0.5), Vec3(20, 0, 0.5)}, .start = f.now, .heading = heading});
  f.advance(3);
  const long before = allocations;
  f.advance(2);
  EXPECT_EQ(allocations - before, 0) << "in flight";
  f.flight.land_now(f.now);
  f.advance(5);
  EXPECT_EQ(allocations - before, 0) << "while it lands";
  f.flight.disarm();
  f.advance(0.1);
  EXPECT_EQ(allocations - before, 0) << "on the ground";
}

/// Calls `action` with ever more allocations that succeed, until all do; returns how often it failed. After
/// each failure `check` is called.
template <class Action, class Check>
int fail_each_allocation(const Action& action, const Check& check) {
  for (int failures = 0;; ++failures) {
    left = failures;
    try {
      action();
      left = -1;
      return failures;
    } catch (const std::bad_alloc&) {
      left = -1;
      check();
    }
  }
}

// As it was: the new path's start was taken with the old path's samples, and the emergency landing that
// follows flew back to where that began.
TEST(Flight, WithoutMemoryForAnotherPathGoesOnAlongTheOldOne) {
  SensedFlight f;
  f.flight.climb(0, 0.5, 0.5);
  f.advance(5);
  f.flight.follow({.points = {Vec3(0, 0, 0.5), Vec3(20, 0, 0.5)}, .start = f.now});
  f.advance(5);
  const Vec3 here = f.flight.expected(f.now).position;
  const TimeNs end = f.flight.trajectory_end();
  Course other{.points = {here, here + Vec3(0, 5, 0)}, .start = f.now};
  other.slow.places = {here};
  const Trajectory ready = sample_trajectory(other.points, 0, f.now, f.flight.limits(), {});
  const int failures = fail_each_allocation([&] { f.flight.follow(other, ready); },
                                            [&] {
                                              EXPECT_EQ(f.flight.expected(f.now).position, here);
                                              EXPECT_EQ(f.flight.trajectory_end(), end);
                                            });
  EXPECT_GE(failures, 2);
  EXPECT_NEAR(f.flight.expected(f.flight.trajectory_end()).position.y(), 5, 1e-6);
}

// As it was: a record without memory counted as held, and was looked for in vain the next time it came.
TEST(RecordStore, WithoutMemoryForARecordDoesNotHoldIt) {
  RecordStore store(100);
  SentRecord record;
  record.author = 1;
  record.number = 1;
  record.bytes = Bytes(200, 7);
  const int failures =
      fail_each_allocation([&] { EXPECT_EQ(store.take(record), RecordStore::Taken::fresh); }, [] {});
  EXPECT_GE(failures, 1);
  EXPECT_EQ(store.take(record), RecordStore::Taken::known);
  ASSERT_NE(store.find(1, 1), nullptr);
  EXPECT_EQ(store.find(1, 1)->bytes, record.bytes);
}

TEST(Flight, CountsAllocationsHere) {
  const long before = allocations;
  const auto p = std::make_unique<std::vector<int>>(100);
  EXPECT_EQ(allocations - before, 2) << "or the other test would prove nothing";
}

}  // namespace
}  // namespace karst::core
