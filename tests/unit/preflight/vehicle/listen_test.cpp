#include "sdk/preflight/vehicle/listen.h"

#include <gtest/gtest.h>

#include <functional>

namespace karst::preflight {
namespace {

using core::kMillisecond;
using core::kSecond;
using core::TimeNs;

/// Sends an IMU sample every 10 ms and a scan every 100 ms.
class FakeVehicle final : public core::Vehicle {
 public:
  core::VehicleDescription description() const override { return described; }
  void start(core::Executive& executive, core::VehicleSink& sink) override {
    ++started;
    executive.every("fake", 10 * kMillisecond, 10 * kMillisecond, [this, &executive, &sink] {
      const TimeNs now = executive.now();
      sink.on_imu({now - kMillisecond, {0, 0, 9.81}, {0, 0, 0}});
      if (now % (100 * kMillisecond) == 0) sink.on_lidar(std::make_shared<core::LidarScan>());
      if (now % kSecond == 0) sink.on_battery({now, 40, 0.9, 30, 500});
      if (extra) extra(now, sink);
    });
  }
  void command(const core::Command&) override { ++commands; }
  std::vector<core::VehicleCheck> checks() const override {
    return {{"P", "1", started ? "1" : "", started > 0}};
  }
  void finish() override { ++finished; }

  core::VehicleDescription described;
  std::function<void(TimeNs, core::VehicleSink&)> extra;
  int started = 0, commands = 0, finished = 0;
};

const std::atomic<bool> kNotInterrupted = false;

TEST(Listen, RecordsAndNeverCommands) {
  FakeVehicle vehicle;
  const VehicleRecord r = listen(vehicle, {.rest = 5 * kSecond}, kNotInterrupted);
  EXPECT_EQ(vehicle.commands, 0);
  EXPECT_EQ(vehicle.finished, 1);
  EXPECT_EQ(r.imu.size(), 500u);
  ASSERT_EQ(r.imu_arrivals.size(), 500u);
  EXPECT_EQ(r.imu_arrivals[7].came - r.imu_arrivals[7].stamp, kMillisecond);
  EXPECT_EQ(r.lidar_arrivals.size(), 50u);
  EXPECT_EQ(r.scans_at_rest.size(), 40u) << "more are of no use";
  EXPECT_EQ(r.battery.size(), 5u);
  EXPECT_FALSE(r.has_motion());
  EXPECT_EQ(r.rest_end, 5 * kSecond);
  ASSERT_EQ(r.checks.size(), 1u);
  EXPECT_EQ(r.checks[0].found, "1") << "asked after the start";
}

TEST(Listen, KeepsAllScansOfTheMotion) {
  FakeVehicle vehicle;
  std::string steps;
  const VehicleRecord r =
      listen(vehicle,
             {.rest = 3 * kSecond,
              .motion = 6 * kSecond,
              .begins = [&](ListenStep s) { steps += s == ListenStep::rest ? 'R' : 'M'; }},
             kNotInterrupted);
  EXPECT_EQ(steps, "RM");
  EXPECT_TRUE(r.has_motion());
  EXPECT_EQ(r.scans_in_motion.size(), 60u);
  EXPECT_EQ(r.end, 9 * kSecond);
}

TEST(Listen, EndsWithTheVehicle) {
  FakeVehicle vehicle;
  vehicle.extra = [](TimeNs now, core::VehicleSink& sink) {
    if (now == 2 * kSecond) sink.on_lost(now, core::MissionOutcome::lost, "the link is down");
  };
  const VehicleRecord r = listen(vehicle, {.rest = 5 * kSecond, .motion = 5 * kSecond}, kNotInterrupted);
  EXPECT_EQ(r.lost, "the link is down");
  EXPECT_EQ(r.rest_end, 2 * kSecond);
  EXPECT_FALSE(r.has_motion());
}

TEST(Listen, NotesALiftOffAtRestButNotInTheHand) {
  FakeVehicle vehicle;
  TimeNs lifts = 7 * kSecond;
  vehicle.extra = [&](TimeNs now, core::VehicleSink& sink) {
    if (now == lifts) sink.on_lift_off(now);
  };
  const ListenOptions how{.rest = 5 * kSecond, .motion = 5 * kSecond};
  EXPECT_FALSE(listen(vehicle, how, kNotInterrupted).lifted_off);
  lifts = 2 * kSecond;
  EXPECT_TRUE(listen(vehicle, how, kNotInterrupted).lifted_off);
}

TEST(Listen, CanBeInterrupted) {
  FakeVehicle vehicle;
  std::atomic<bool> interrupted = false;
  vehicle.extra = [&](TimeNs now, core::VehicleSink&) { interrupted = now >= kSecond; };
  EXPECT_LE(listen(vehicle, {.rest = 5 * kSecond}, interrupted).end, kSecond + 10 * kMillisecond);
  EXPECT_EQ(vehicle.finished, 1);
}

TEST(Listen, SortsDepthImagesByCamera) {
  FakeVehicle vehicle;
  const auto up = std::make_shared<core::CameraModel>(), down = std::make_shared<core::CameraModel>();
  vehicle.described.cameras = {up, down};
  vehicle.extra = [&](TimeNs now, core::VehicleSink& sink) {
    if (now % (200 * kMillisecond) != 0) return;
    sink.on_depth(std::make_shared<core::DepthImage>(core::DepthImage{now, down, {}}));
    sink.on_depth(std::make_shared<core::DepthImage>(core::DepthImage{now, nullptr, {}}));
  };
  const VehicleRecord r = listen(vehicle, {.rest = 4 * kSecond}, kNotInterrupted);
  ASSERT_EQ(r.cameras.size(), 2u);
  EXPECT_EQ(r.cameras[0].arrivals.size(), 0u);
  EXPECT_EQ(r.cameras[1].arrivals.size(), 20u);
  EXPECT_EQ(r.cameras[1].images.size(), 10u);
}

}  // namespace
}  // namespace karst::preflight
