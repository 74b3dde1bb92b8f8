// Out of memory the vehicle still has to come down: what flies it allocates none. A program of its own, for
// it counts every allocation.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "core_stack/mission/flight/flight.h"

namespace {
long allocations = 0;
}

// The other forms of new and delete come to these.
void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

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
      flight.on_imu({now, Vec3(0, 0, 9.81), Vec3::Zero()});
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

TEST(Flight, CountsAllocationsHere) {
  const long before = allocations;
  const auto p = std::make_unique<std::vector<int>>(100);
  EXPECT_EQ(allocations - before, 2) << "or the other test would prove nothing";
}

}  // namespace
}  // namespace karst::core
