// Commands, parameters, telemetry and links.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>

#include "core_stack/common/error.h"
#include "plugins/mavlink/command_queue.h"
#include "plugins/mavlink/connection.h"
#include "plugins/mavlink/held_messages.h"
#include "plugins/mavlink/link/open_link.h"
#include "plugins/mavlink/link/serial_link.h"
#include "plugins/mavlink/link/udp_link.h"
#include "plugins/mavlink/parameters.h"
#include "plugins/mavlink/sensor_health.h"
#include "plugins/mavlink/telemetry.h"

namespace karst::mavlink {
namespace {

using core::kMillisecond;
using core::kSecond;
using core::TimeNs;
using core::Vec3;

CommandLong numbered(Cmd number) {
  CommandLong m;
  m.command = static_cast<std::uint16_t>(number);
  return m;
}

TEST(CommandQueue, RepeatsUntilAnsweredAndThenGoesOn) {
  CommandQueue queue;
  std::vector<CmdResult> results;
  const auto note = [&results](CmdResult r) { results.push_back(r); };
  queue.add(numbered(Cmd::do_set_mode), note);
  queue.add(numbered(Cmd::nav_takeoff), note);
  ASSERT_TRUE(queue.due(0));
  EXPECT_FALSE(queue.due(100 * kMillisecond));
  const auto again = queue.due(500 * kMillisecond);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->confirmation, 1);
  queue.on_ack({static_cast<std::uint16_t>(Cmd::nav_takeoff), 0, 0, 0, 0, 0});
  EXPECT_TRUE(results.empty()) << "not asked yet";
  queue.on_ack({static_cast<std::uint16_t>(Cmd::do_set_mode), 5, 0, 0, 0, 0});
  EXPECT_TRUE(results.empty()) << "in progress";
  queue.on_ack({static_cast<std::uint16_t>(Cmd::do_set_mode), 2, 0, 0, 0, 0});
  EXPECT_EQ(results, std::vector<CmdResult>{CmdResult::denied});
  int sent = 0;
  for (TimeNs t = kSecond; t < 10 * kSecond; t += 50 * kMillisecond) sent += queue.due(t) ? 1 : 0;
  EXPECT_EQ(sent, 5);
  EXPECT_EQ(results.back(), CmdResult::no_answer);
  EXPECT_FALSE(queue.waits_for(Cmd::nav_takeoff));
}

TEST(Parameters, AnIntegerComesAsBitsOrAsAValue) {
  ParamValue p;
  p.param_type = 6;
  p.param_value = std::bit_cast<float>(std::int32_t{5});
  EXPECT_EQ(value_of(p, Firmware::px4), 5);
  p.param_value = 5;
  EXPECT_EQ(value_of(p, Firmware::ardupilot), 5);
  p.param_type = 9;
  p.param_value = 0.5f;
  EXPECT_EQ(value_of(p, Firmware::px4), 0.5);
}

TEST(Parameters, RulesHoldForWhatTheyAllow) {
  for (const Firmware firmware : {Firmware::px4, Firmware::ardupilot})
    for (const ParameterRule& rule : rules_of(firmware, Control::rates, 0.5)) {
      EXPECT_LE(rule.name.size(), 16u);
      EXPECT_FALSE(rule.required.empty());
      EXPECT_FALSE(rule.holds(-1)) << rule.name;
      EXPECT_FALSE(rule.holds(std::nan(""))) << rule.name;
    }
  const auto rule = [](const char* name) {
    for (const ParameterRule& r : rules_of(Firmware::px4, Control::rates, 0.5))
      if (r.name == name) return r;
    throw std::out_of_range(name);
  };
  EXPECT_TRUE(rule("COM_OF_LOSS_T").holds(0.5));
  EXPECT_FALSE(rule("COM_OF_LOSS_T").holds(5));
  EXPECT_TRUE(rule("EKF2_EV_CTRL").holds(15));
  EXPECT_FALSE(rule("EKF2_EV_CTRL").holds(7)) << "no yaw";
  EXPECT_FALSE(rule("NAV_RCL_ACT").holds(2)) << "a return flies through the rock";
  EXPECT_FALSE(rule("MPC_THR_HOVER").holds(0.6));
}

TEST(Parameters, AreAskedForUntilTheyCome) {
  ParameterReader reader(rules_of(Firmware::px4, Control::position, 0.5), Firmware::px4);
  std::map<std::string, int> asked;
  for (TimeNs t = kSecond; t < 60 * kSecond; t += 10 * kMillisecond) {
    const auto request = reader.due(t);
    if (!request) continue;
    const std::string name(request->param_id.data(), strnlen(request->param_id.data(), 16));
    ++asked[name];
    if (name != "COM_OF_LOSS_T" || asked[name] < 3) continue;
    ParamValue answer;
    answer.param_id = request->param_id;
    answer.param_type = 9;
    answer.param_value = 2;
    reader.on_value(answer);
  }
  EXPECT_EQ(asked["COM_OF_LOSS_T"], 3);
  EXPECT_GE(asked["EKF2_EV_CTRL"], 5);
  for (const core::VehicleCheck& c : reader.checks()) {
    EXPECT_FALSE(c.holds);
    EXPECT_EQ(c.found, c.name == "COM_OF_LOSS_T" ? "2" : "");
  }
}

/// Keeps what the core would get.
struct Heard final : core::VehicleSink {
  std::vector<core::ImuSample> imu;
  std::vector<core::MagnetometerSample> field;
  std::vector<core::BarometerSample> height;
  std::vector<core::BatteryStatus> battery;
  std::string ground;
  void on_lidar(std::shared_ptr<const core::LidarScan>) override {}
  void on_depth(std::shared_ptr<const core::DepthImage>) override {}
  void on_imu(const core::ImuSample& s) override { imu.push_back(s); }
  void on_magnetometer(const core::MagnetometerSample& s) override { field.push_back(s); }
  void on_barometer(const core::BarometerSample& s) override { height.push_back(s); }
  void on_pose(const core::PoseSample&) override {}
  void on_battery(const core::BatteryStatus& s) override { battery.push_back(s); }
  void on_ground(TimeNs) override { ground += 'G'; }
  void on_lift_off(TimeNs) override { ground += 'A'; }
  void on_lost(TimeNs, core::MissionOutcome, const std::string&) override {}
};

struct TelemetryTest : testing::Test {
  Telemetry telemetry{50};
  ClockSync clock;
  Heard heard;
  TimeNs now = 10 * kSecond;
  static constexpr TimeNs kAhead = 500 * kSecond;
  void synchronize() { clock.note_answer(now - 20 * kMillisecond, now - 10 * kMillisecond + kAhead, now); }
  template <class Message>
  void take(const Message& m) {
    telemetry.take(frame_of(m, {1, 1}), clock, now, heard);
  }
};

TEST_F(TelemetryTest, AnImuSampleWaitsForTheClockAndComesInItsFrameAndTime) {
  HighresImu m;
  m.time_usec = static_cast<std::uint64_t>((now - 30 * kMillisecond + kAhead) / 1000);
  m.xacc = 1, m.yacc = 2, m.zacc = -9.81f;
  m.zgyro = 0.5f;
  m.xmag = 0.2f, m.zmag = 0.4f;
  m.abs_pressure = 1000;
  m.fields_updated = 0x3f;
  take(m);
  EXPECT_TRUE(heard.imu.empty());
  synchronize();
  take(m);
  ASSERT_EQ(heard.imu.size(), 1u);
  EXPECT_EQ(heard.imu[0].stamp, now - 30 * kMillisecond);
  EXPECT_LT((heard.imu[0].specific_force_mps2 - Vec3(1, -2, 9.81)).norm(), 1e-6);
  EXPECT_LT((heard.imu[0].body_rate_radps - Vec3(0, 0, -0.5)).norm(), 1e-6);
  EXPECT_TRUE(heard.field.empty() && heard.height.empty()) << "they were not updated";
  take(m);
  EXPECT_EQ(heard.imu.size(), 1u) << "the same again";
  m.time_usec += 5000;
  m.fields_updated = 0xffff;
  take(m);
  ASSERT_EQ(heard.field.size(), 1u);
  EXPECT_LT((heard.field[0].field_ut - Vec3(20, 0, -40)).norm(), 1e-4);
  m.time_usec += 10'000'000;
  m.abs_pressure = 999;
  take(m);
  EXPECT_EQ(heard.imu.back().stamp, now) << "never from the future";
  ASSERT_EQ(heard.height.size(), 2u);
  EXPECT_NEAR(heard.height[1].height_m, 8.4, 0.1);  // near the ground a hPa is 8.4 m
}

TEST_F(TelemetryTest, WhatNoSensorCanMeasureReachesNobody) {
  synchronize();
  for (const float bad : {std::nanf(""), INFINITY, 1e9f}) {
    HighresImu m;
    m.time_usec = static_cast<std::uint64_t>((now + kAhead) / 1000);
    m.fields_updated = 0xffff;
    m.abs_pressure = bad;
    m.zacc = bad;
    take(m);
    m.zacc = 0, m.xgyro = bad;
    take(m);
  }
  EXPECT_TRUE(heard.imu.empty());
  EXPECT_TRUE(heard.height.empty());
  take(AttitudeQuaternion{0, 0, 0, 0, 0, 0, 0, 0, {}});
  EXPECT_FALSE(telemetry.orientation());
  EXPECT_FALSE(telemetry.standing()) << "nobody has said so";
}

TEST_F(TelemetryTest, ArduPilotsUnits) {
  synchronize();
  RawImu m;
  m.time_usec = static_cast<std::uint64_t>((now + kAhead) / 1000);
  m.zacc = -1000, m.xgyro = 250;
  m.xmag = 200;
  take(m);
  ASSERT_EQ(heard.imu.size(), 1u);
  EXPECT_NEAR(heard.imu[0].specific_force_mps2.z(), 9.80665, 1e-9);
  EXPECT_NEAR(heard.imu[0].body_rate_radps.x(), 0.25, 1e-9);
  ASSERT_EQ(heard.field.size(), 1u);
  EXPECT_NEAR(heard.field[0].field_ut.x(), 20, 1e-9);
}

TEST_F(TelemetryTest, GroundIsToldOnceAndTheBatteryByWhatFlyingTakes) {
  take(ExtendedSysState{0, 0});
  EXPECT_EQ(heard.ground, "");
  for (const int state : {1, 1, 3, 2, 2, 4, 1}) take(ExtendedSysState{0, static_cast<std::uint8_t>(state)});
  EXPECT_EQ(heard.ground, "GAG");
  take(ExtendedSysState{0, 2});
  BatteryStatus m;
  m.voltages.fill(65535);
  m.voltages[0] = 16000;
  m.current_battery = 1875;  // 300 W
  m.battery_remaining = 50;
  take(m);
  ASSERT_EQ(heard.battery.size(), 1u);
  EXPECT_NEAR(heard.battery[0].power_w, 300, 1e-9);
  EXPECT_NEAR(heard.battery[0].seconds_left, 300, 1e-6);  // 25 Wh at 300 W
  m.battery_remaining = -1;
  take(m);
  EXPECT_EQ(heard.battery.size(), 1u) << "not known";
}

TEST(SensorHealth, NamesWhatIsUsedAndUnhealthyAndAsksForTheTransmitter) {
  EXPECT_EQ(health_checks(std::nullopt)[0].found, "");
  SysStatus m;
  m.onboard_control_sensors_enabled = 0x1 | 0x2 | 0x8 | 0x10000 | 0x200000;
  m.onboard_control_sensors_health = 0x2 | 0x10000;
  auto checks = health_checks(m);
  EXPECT_FALSE(checks[0].holds);
  EXPECT_EQ(checks[0].found, "unhealthy: gyroscope, barometer") << "the magnetometer is not used";
  EXPECT_TRUE(checks[1].holds);
  m.onboard_control_sensors_health = 0x1 | 0x2 | 0x8;
  checks = health_checks(m);
  EXPECT_TRUE(checks[0].holds);
  EXPECT_FALSE(checks[1].holds);
  EXPECT_EQ(checks[1].found, "not heard");
}

TEST(HeldMessages, WaitForTheImuButNotForEver) {
  HeldMessages held;
  std::string out;
  held.hold(100 * kMillisecond, 110 * kMillisecond, [&] { out += 'a'; });
  held.hold(200 * kMillisecond, 210 * kMillisecond, [&] { out += 'b'; });
  held.release(std::nullopt, 120 * kMillisecond);
  held.release(90 * kMillisecond, 120 * kMillisecond);
  EXPECT_EQ(out, "");
  held.release(100 * kMillisecond, 140 * kMillisecond);
  EXPECT_EQ(out, "a");
  held.release(150 * kMillisecond, 600 * kMillisecond);
  EXPECT_EQ(out, "ab");
}

std::string error_of(const std::string& address) {
  try {
    open_link(address, {1, kAutopilotComponent});
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "";
}

TEST(Link, ABadAddressIsAnErrorThatNamesIt) {
  for (const char* address :
       {"", "udp", "udp:", "udp:0", "udp:99999", "udp:12x", "tcp:1.2.3.4:5", "serial:/dev/null",
        "udp:nowhere:14550", "serial:/dev/null:12345", "serial:/no/such/line:57600"}) {
    const std::string e = error_of(address);
    EXPECT_FALSE(e.empty()) << address;
  }
  EXPECT_NE(error_of("serial:/dev/null:12345").find("57600"), std::string::npos) << "the rates there are";
}

TEST(Link, UdpKeepsToTheAutopilotThatSpokeFirst) {
  UdpLink waits = UdpLink::wait_at(0, {1, 1});
  UdpLink peer = UdpLink::to("127.0.0.1", waits.port()), stranger = UdpLink::to("127.0.0.1", waits.port());
  const auto bytes = to_wire(frame_of(Heartbeat{}, {1, 1}));
  std::vector<std::uint8_t> got;
  waits.send(bytes);  // to nobody yet
  stranger.send(std::vector<std::uint8_t>(300, 0xfd));
  stranger.send(to_wire(frame_of(Heartbeat{}, {255, 190})));  // a ground station
  peer.send(bytes);
  waits.receive(got);
  EXPECT_EQ(got, bytes);
  stranger.send(bytes);
  got.clear();
  waits.receive(got);
  EXPECT_TRUE(got.empty());
  waits.send(bytes);
  peer.receive(got);
  EXPECT_EQ(got, bytes);
}

TEST(Link, UdpTakesAPeerAtAnotherPortOnceTheFirstWasSilent) {
  UdpLink waits = UdpLink::wait_at(0, {1, 1});
  const auto bytes = to_wire(frame_of(Heartbeat{}, {1, 1}));
  std::vector<std::uint8_t> got;
  {
    UdpLink first = UdpLink::to("127.0.0.1", waits.port());
    first.send(bytes);
    waits.receive(got);
  }
  UdpLink again = UdpLink::to("127.0.0.1", waits.port());
  got.clear();
  for (int i = 0; i < 100 && got.empty(); ++i) {
    again.send(bytes);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    waits.receive(got);
  }
  EXPECT_FALSE(got.empty());
  waits.send(bytes);
  got.clear();
  again.receive(got);
  EXPECT_EQ(got, bytes);
}

/// The autopilot's end of a serial line.
int open_master() {
  const int master = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
  EXPECT_GE(master, 0);
  EXPECT_EQ(::grantpt(master), 0);
  EXPECT_EQ(::unlockpt(master), 0);
  return master;
}

TEST(Link, ASerialLineThatWasUnpluggedIsOpenedAgain) {
  const std::filesystem::path device = std::filesystem::path(testing::TempDir()) / "karst_replugged";
  std::filesystem::remove(device);
  int master = open_master();
  std::filesystem::create_symlink(::ptsname(master), device);
  SerialLink line(device, 921600);
  const std::vector<std::uint8_t> sent{1, 2, 3};
  std::vector<std::uint8_t> got;
  ::close(master);
  std::filesystem::remove(device);
  line.receive(got);
  line.send(sent);
  line.receive(got);
  EXPECT_TRUE(got.empty());
  master = open_master();
  std::filesystem::create_symlink(::ptsname(master), device);
  for (int i = 0; i < 100 && got.empty(); ++i) {  // it looks twice a second
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    ASSERT_EQ(::write(master, sent.data(), sent.size()), 3);
    line.receive(got);
  }
  ASSERT_GE(got.size(), 3u);
  EXPECT_TRUE(std::equal(sent.begin(), sent.end(), got.begin()));
  ::close(master);
  std::filesystem::remove(device);
}

TEST(Link, ASerialLineCarriesAllBytesUnchanged) {
  const int master = open_master();
  SerialLink line(::ptsname(master), 921600);
  std::vector<std::uint8_t> sent(256), got;
  for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = static_cast<std::uint8_t>(i);
  line.send(sent);
  std::array<std::uint8_t, 512> out{};
  ASSERT_EQ(::read(master, out.data(), out.size()), 256);
  EXPECT_TRUE(std::equal(sent.begin(), sent.end(), out.begin()));
  ASSERT_EQ(::write(master, sent.data(), sent.size()), 256);
  line.receive(got);
  EXPECT_EQ(got, sent);
  ::close(master);
}

}  // namespace
}  // namespace karst::mavlink
