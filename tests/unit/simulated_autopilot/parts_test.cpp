// The link, the script, the modes and the observer of the simulated autopilot.
#include <gtest/gtest.h>

#include "core_stack/common/error.h"
#include "core_stack/common/so3.h"
#include "plugins/simulated_autopilot/flight_modes.h"
#include "plugins/simulated_autopilot/observer.h"
#include "plugins/simulated_autopilot/pilot_script.h"
#include "plugins/simulated_autopilot/simulated_link.h"

namespace karst::sim {
namespace {

using core::kMillisecond;
using core::kSecond;
using core::Quat;
using core::TimeNs;
using core::Vec3;
using mavlink::CmdResult;

TEST(SimulatedLink, IsLateByLatencyAndJitterInOrderAndLosesItsFraction) {
  TimeNs now = 0;
  SimulatedLink link({.latency_s = 0.05, .jitter_s = 0.02, .loss = 0.1}, 7, [&now] { return now; });
  const auto core = link.open(SimulatedLink::End::core), autopilot = link.open(SimulatedLink::End::autopilot);
  int arrived = 0, last = -1;
  for (int i = 0; i < 2000; ++i, now += kMillisecond) {
    const auto number = static_cast<std::uint8_t>(i % 256);
    core->send(std::array<std::uint8_t, 2>{number, static_cast<std::uint8_t>(i / 256)});
    std::vector<std::uint8_t> got;
    autopilot->receive(got);
    for (std::size_t at = 0; at < got.size(); at += 2) {
      const int n = got[at] + 256 * got[at + 1];
      EXPECT_GT(n, last) << "in order";
      last = n;
      EXPECT_GE(i - n, 50);
      EXPECT_LE(i - n, 71);
      ++arrived;
    }
    core->receive(got);
    EXPECT_TRUE(got.size() % 2 == 0);
  }
  EXPECT_NEAR(arrived / 1940.0, 0.9, 0.03);
}

TEST(SimulatedLink, LostForAWhileItForgetsWhatIsUnderWay) {
  TimeNs now = 0;
  SimulatedLink link({.latency_s = 0.05, .jitter_s = 0}, 7, [&now] { return now; });
  const auto core = link.open(SimulatedLink::End::core), autopilot = link.open(SimulatedLink::End::autopilot);
  const std::array<std::uint8_t, 1> byte{1};
  std::vector<std::uint8_t> got;
  core->send(byte);
  link.lose_until(kSecond);
  for (; now < kSecond; now += 10 * kMillisecond) {
    core->send(byte);
    autopilot->receive(got);
  }
  EXPECT_TRUE(got.empty());
  core->send(byte);
  now += 60 * kMillisecond;
  autopilot->receive(got);
  EXPECT_EQ(got.size(), 1u);
}

TEST(PilotScript, IsReadOrRefusedWithItsPlace) {
  const auto script = read_pilot_script("2 arm, 3.5 hand_over,40 take_over");
  ASSERT_EQ(script.size(), 3u);
  EXPECT_EQ(script[1].at, 3500 * kMillisecond);
  EXPECT_EQ(script[2].action, PilotAction::take_over);
  EXPECT_TRUE(read_pilot_script("").empty());
  for (const char* bad :
       {"arm", "2", "2 dance", "2 arm now", "5 arm, 3 hand_over", "-1 arm", "nan arm", "2 arm,,"}) {
    try {
      read_pilot_script(bad);
      ADD_FAILURE() << bad;
    } catch (const core::InputError& e) {
      EXPECT_NE(std::string(e.what()).find("simulated_autopilot.pilot"), std::string::npos);
    }
  }
}

ModeInputs in_order(TimeNs now) { return {now, true, true, now - 50 * kMillisecond, now - 2 * kSecond, 1.0}; }

TEST(FlightModes, Px4GrantsOffboardAfterASecondOfSetpointsOnly) {
  FlightModes modes({});
  ModeInputs in = in_order(10 * kSecond);
  in.position_known = false;
  EXPECT_NE(modes.arm(in), CmdResult::accepted);
  in.position_known = true;
  EXPECT_EQ(modes.arm(in), CmdResult::accepted);
  in.streams_since = in.now - 900 * kMillisecond;
  EXPECT_EQ(modes.select(FlightMode::guided, in), CmdResult::temporarily_rejected);
  in.streams_since = in.now - kSecond;
  in.setpoint_at = in.now - kSecond;
  EXPECT_EQ(modes.select(FlightMode::guided, in), CmdResult::temporarily_rejected);
  in.setpoint_at = in.now;
  EXPECT_EQ(modes.select(FlightMode::guided, in), CmdResult::accepted);
  EXPECT_EQ(modes.custom_mode(), 6u << 16);
}

TEST(FlightModes, WithoutSetpointsPx4HoldsOrLandsAndArduPilotStaysInGuided) {
  for (const auto loss : {OffboardLoss::hold, OffboardLoss::land})
    for (const auto firmware : {mavlink::Firmware::px4, mavlink::Firmware::ardupilot}) {
      FlightModes modes({.firmware = firmware, .offboard_loss = loss});
      ModeInputs in = in_order(10 * kSecond);
      modes.arm(in);
      ASSERT_EQ(modes.select(FlightMode::guided, in), CmdResult::accepted);
      in.standing = false;
      in.now += 900 * kMillisecond;
      modes.step(in);
      EXPECT_EQ(modes.mode(), FlightMode::guided);
      in.now += 3 * kSecond;
      modes.step(in);
      if (firmware == mavlink::Firmware::ardupilot) {
        EXPECT_EQ(modes.mode(), FlightMode::guided);
        EXPECT_TRUE(modes.target_timed_out());
      } else {
        EXPECT_EQ(modes.mode(), loss == OffboardLoss::hold ? FlightMode::hold : FlightMode::land);
        EXPECT_EQ(modes.system_status(), mavlink::kCritical);
      }
    }
}

TEST(FlightModes, BatteryAndALostPositionLandAndTheGroundDisarms) {
  FlightModes modes({.battery_failsafe = 0.2});
  ModeInputs in = in_order(10 * kSecond);
  modes.arm(in);
  in.standing = false;
  in.battery_fraction = 0.19;
  modes.step(in);
  EXPECT_EQ(modes.mode(), FlightMode::land);
  EXPECT_EQ(modes.disarm(in), CmdResult::denied) << "in the air";
  in.standing = true;
  modes.step(in);
  in.now += 2 * kSecond;
  modes.step(in);
  EXPECT_FALSE(modes.armed());

  FlightModes blind({});
  in = in_order(10 * kSecond);
  blind.arm(in);
  in.standing = in.position_known = false;
  blind.step(in);
  EXPECT_EQ(blind.mode(), FlightMode::land);
}

/// A circle of 2 m at 1 m/s with the nose along it, NED; the IMU with bias, the vision late.
TEST(Observer, FollowsACircleByLateVisionAndABiasedImu) {
  Observer observer;
  const Vec3 force_bias(0.05, -0.05, 0.05), rate_bias(0.003, -0.003, 0.003);
  const auto truth = [](TimeNs t) {
    const double a = 0.5 * core::seconds(t);
    Motion m;
    m.stamp = t;
    m.position = Vec3(2 * std::cos(a), 2 * std::sin(a), -1.5);
    m.velocity_mps = Vec3(-std::sin(a), std::cos(a), 0);
    m.attitude = Quat(Eigen::AngleAxisd(a + std::numbers::pi / 2, Vec3::UnitZ()));
    m.rate_radps = Vec3(0, 0, 0.5);
    return m;
  };
  constexpr TimeNs kLate = 150 * kMillisecond;
  for (TimeNs t = kSecond; t < 60 * kSecond; t += 5 * kMillisecond) {
    const Motion m = truth(t);
    const Vec3 acceleration = -0.25 * Vec3(m.position.x(), m.position.y(), 0);
    observer.on_imu(t, m.attitude.conjugate() * (acceleration - Vec3(0, 0, 9.81)) + force_bias,
                    m.rate_radps + rate_bias);
    if (t % (25 * kMillisecond) == 0 && t > 2 * kSecond) {
      const Motion seen = truth(t - kLate);
      observer.on_vision(seen.stamp, seen.position, seen.velocity_mps, seen.attitude);
    }
    if (t < 30 * kSecond) continue;
    EXPECT_LT((observer.motion().position - m.position).norm(), 0.03);
    EXPECT_LT((observer.motion().velocity_mps - m.velocity_mps).norm(), 0.05);
    EXPECT_LT(observer.motion().attitude.angularDistance(m.attitude), 0.02);
  }
  EXPECT_TRUE(observer.position_known(5));
  for (TimeNs t = 60 * kSecond; t < 66 * kSecond; t += 5 * kMillisecond)
    observer.on_imu(t, Vec3(0, 0, -9.81), Vec3::Zero());
  EXPECT_FALSE(observer.position_known(5));
}

}  // namespace
}  // namespace karst::sim
