// Missions by MAVLink, against the simulated autopilot: whatever the link, the pilot or the autopilot do, the
// core steers when it may, and nothing is touched.
#include <nlohmann/json.hpp>

#include "core_stack/mission/mission_control.h"
#include "plugins/simulated_autopilot/autopilot_vehicle.h"
#include "plugins/simulator/cave_generator/generate_cave.h"
#include "tests/closed_loop/command.h"
#include "tests/closed_loop/tourist.h"

namespace karst::core {
namespace {

using mavlink::Control;
using mavlink::Engage;
using mavlink::Firmware;
using mavlink::Resume;
using sim::AutopilotVehicle;
using sim::AutopilotVehicleOptions;
using sim::PilotAction;
using Texts = std::vector<std::string>;

const cave::Cave& small_cave() {
  static const cave::Cave small = [] {
    cave::GeneratedCave made = cave::generate_cave(cave::cave_preset("small"), 7);
    cave::CaveDescription description;
    description.file = "made in code";
    description.start = made.start;
    return cave::Cave{description, cave::RayScene(std::move(made.mesh))};
  }();
  return small;
}

struct Flown {
  MissionResult result;
  Texts authority, phases;
  bool armed = false;
  nlohmann::json link;
  std::string events;
};

/// Ten times a second, while the mission is in that phase.
using Script = std::function<void(AutopilotVehicle&, Phase, TimeNs)>;

AutopilotVehicleOptions usual(Firmware firmware) {
  AutopilotVehicleOptions o;
  o.autopilot.firmware = firmware;
  o.link.latency_s = 0.03;
  o.link.loss = 0.02;
  o.simulator.vehicle = sim::VehiclePreset::lidar_only_uav;
  o.simulator.lidar.columns = 256;
  return o;
}

Flown fly(const std::string& name, const AutopilotVehicleOptions& o, const Script& script = {},
          double home_after_s = 18, double limit_s = 120) {
  const auto folder = fresh_folder("mavlink_" + name);
  VehicleSetup setup;
  setup.run_dir = folder.string();
  CoreOptions options;
  options.mission.max_flight_time_s = 200;
  setup.climb_m = options.mission.takeoff_height_m;
  Flown out;
  {
    Recorder recorder(folder);
    Executive executive(1);
    AutopilotVehicle vehicle(o, setup, small_cave());
    Tourist policy(from_seconds(home_after_s));
    MissionControl control(options, vehicle, executive, policy, recorder, nullptr);
    executive.every("script", kSecond / 10, kSecond / 10, [&] {
      if (script) script(vehicle, control.phase(), executive.now());
    });
    out.result = control.run([&](const MissionStatus& s) { return seconds(s.time) < limit_s; });
    executive.run_until(executive.now() + 2 * kSecond, [] { return false; });
    out.armed = vehicle.autopilot().modes().armed();
  }
  out.events = bytes_of(folder / "events.jsonl");
  std::istringstream lines(out.events);
  for (std::string line; std::getline(lines, line);) {
    const auto e = nlohmann::json::parse(line);
    if (e.value("kind", "") == "authority")
      out.authority.push_back(e["who"].get<std::string>() + ": " + e["reason"].get<std::string>());
    if (e.value("kind", "") == "phase") out.phases.push_back(e["phase"]);
  }
  out.link = nlohmann::json::parse(bytes_of(folder / "mavlink.json"));
  return out;
}

void expect_landed(const Flown& f) {
  EXPECT_EQ(f.result.outcome, MissionOutcome::landed) << f.result.reason << '\n' << f.events;
  EXPECT_EQ(f.result.reason, "at the start");
  EXPECT_TRUE(f.result.stands);
}

bool has(const Texts& all, const std::string& part) {
  return std::any_of(all.begin(), all.end(),
                     [&](const std::string& t) { return t.find(part) != std::string::npos; });
}

std::string name_in_test(const testing::TestParamInfo<Firmware>& info) { return name_of(info.param); }

class MavlinkFlight : public testing::TestWithParam<Firmware> {
 protected:
  std::string name(const std::string& what) const { return what + "_" + name_of(GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(Firmware, MavlinkFlight, testing::Values(Firmware::px4, Firmware::ardupilot),
                         name_in_test);

TEST_P(MavlinkFlight, AWholeMissionTwiceTheSameByteForByte) {
  const AutopilotVehicleOptions o = usual(GetParam());
  const Flown first = fly(name("whole"), o), second = fly(name("whole"), o);
  expect_landed(first);
  EXPECT_EQ(first.phases, (Texts{"standby", "takeoff", "explore", "home", "land", "done"}));
  EXPECT_FALSE(has(first.authority, "autopilot: "));
  EXPECT_EQ(first.events, second.events);
  EXPECT_GT(
      first.link["received"]["messages"][GetParam() == Firmware::px4 ? "HIGHRES_IMU" : "RAW_IMU"]["messages"],
      1000);
}

TEST_P(MavlinkFlight, ALinkLostForFiveSecondsInEachPhaseIsWaitedForAndTheMissionGoesOn) {
  for (const Phase phase : {Phase::explore, Phase::home, Phase::land}) {
    SCOPED_TRACE(name_of(phase));
    std::optional<TimeNs> lost_at;
    TimeNs since = 0;
    const Flown f =
        fly(name("link_lost"), usual(GetParam()), [&](AutopilotVehicle& v, Phase now_in, TimeNs now) {
          if (now_in != phase) since = now;
          if (lost_at || now - since < kSecond) return;
          lost_at = now;
          v.lose_link_for(5);
        });
    ASSERT_TRUE(lost_at);
    EXPECT_TRUE(has(f.authority, "autopilot: no heartbeat"));
    EXPECT_TRUE(has(f.phases, "manual"));
    if (phase == Phase::land && f.result.outcome == MissionOutcome::aborted) {
      // It goes on down by the last target until that times out, and may reach the ground.
      EXPECT_TRUE(f.result.reason.starts_with("landed by the autopilot, 0.")) << f.result.reason;
      EXPECT_TRUE(f.result.stands);
      continue;
    }
    expect_landed(f);
    EXPECT_TRUE(f.authority.back().starts_with("core: ")) << f.authority.back();
  }
}

TEST_P(MavlinkFlight, ThePilotTakesOverAndGivesBack) {
  std::optional<TimeNs> taken, given;
  const Flown f = fly(name("pilot"), usual(GetParam()), [&](AutopilotVehicle& v, Phase phase, TimeNs now) {
    if (!taken && phase == Phase::explore && now > 12 * kSecond) {
      taken = now;
      v.pilot(PilotAction::take_over);
    }
    if (!taken || now - *taken < 6 * kSecond) return;
    if (!given) v.pilot(PilotAction::hand_over);
    given = given.value_or(now);
  });
  expect_landed(f);
  EXPECT_EQ(f.phases, (Texts{"standby", "takeoff", "explore", "manual", "explore", "home", "land", "done"}));
  EXPECT_TRUE(has(f.authority, GetParam() == Firmware::px4 ? "pilot: mode position" : "pilot: mode loiter"));
}

TEST_P(MavlinkFlight, WhatThePilotTookDuringALostLinkIsNotAskedFor) {
  std::optional<TimeNs> lost_at;
  bool took = false;
  const Flown f = fly(
      name("pilot_in_silence"), usual(GetParam()),
      [&](AutopilotVehicle& v, Phase phase, TimeNs now) {
        if (!lost_at && phase == Phase::explore && now > 12 * kSecond) {
          lost_at = now;
          v.lose_link_for(5);
        }
        if (!took && lost_at && now - *lost_at > 3 * kSecond) {
          took = true;
          v.pilot(PilotAction::take_over);
        }
        if (took && now - *lost_at == 15 * kSecond) {
          EXPECT_EQ(phase, Phase::manual);
          v.pilot(PilotAction::land);
        }
      },
      100);
  EXPECT_EQ(f.result.outcome, MissionOutcome::aborted) << f.result.reason;
  EXPECT_TRUE(f.result.reason.starts_with("landed by the pilot")) << f.result.reason;
  EXPECT_TRUE(f.result.stands);
}

TEST_P(MavlinkFlight, RefusedItWaitsOnTheGroundSaysSoAndFliesOnceItIsGranted) {
  AutopilotVehicleOptions o = usual(GetParam());
  o.autopilot.pilot = "2 arm";
  o.autopilot.refuse_offboard_until_s = 10;
  o.autopilot.answer_delay_s = 0.2;
  o.mavlink.engage = Engage::arming;
  const Flown f = fly(name("refused"), o, [](AutopilotVehicle& v, Phase phase, TimeNs now) {
    if (now < 10 * kSecond) {
      EXPECT_EQ(phase, Phase::standby);
      EXPECT_FALSE(v.simulated().airborne());
    }
  });
  expect_landed(f);
  EXPECT_TRUE(has(f.authority, "refused: denied"));
  EXPECT_FALSE(f.armed) << "karst disarms where it has landed";
}

TEST_P(MavlinkFlight, TheAutopilotsBatteryFailsafeWins) {
  AutopilotVehicleOptions o = usual(GetParam());
  o.autopilot.battery_failsafe = 0.97;
  o.mavlink.resume = Resume::after_link_loss;
  const Flown f = fly(name("battery"), o, {}, 100);
  EXPECT_EQ(f.result.outcome, MissionOutcome::aborted) << f.result.reason;
  EXPECT_TRUE(f.result.reason.starts_with("landed by the autopilot")) << f.result.reason;
  EXPECT_TRUE(has(f.authority, "autopilot: mode land: Failsafe: critical battery")) << f.events;
  EXPECT_EQ(f.phases.back(), "done");
  EXPECT_EQ(f.phases[f.phases.size() - 2], "manual") << "it never steers again";
}

TEST_P(MavlinkFlight, GarbageOthersAndAClockFarOffOnTheLink) {
  AutopilotVehicleOptions o = usual(GetParam());
  o.link.garbage = 0.2;
  o.link.corruption = 0.02;
  o.autopilot.other_system = true;
  o.autopilot.clock_offset_s = 98765.4;
  o.autopilot.clock_drift_ppm = 100;
  const Flown f = fly(name("garbage"), o);
  expect_landed(f);
  EXPECT_EQ(f.phases, (Texts{"standby", "takeoff", "explore", "home", "land", "done"}));
  EXPECT_GT(f.link["garbage_bytes"], 1000);
  EXPECT_GT(f.link["from_others"], 30);
}

TEST(MavlinkChecks, NameWhatDoesNotHold) {
  for (const Firmware firmware : {Firmware::px4, Firmware::ardupilot})
    for (const bool right : {true, false}) {
      AutopilotVehicleOptions o = usual(firmware);
      o.autopilot.pilot = "";
      if (!right)
        o.autopilot.parameters =
            firmware == Firmware::px4 ? "COM_OF_LOSS_T=5 EKF2_EV_CTRL=0" : "FS_GCS_ENABLE=1";
      if (!right && firmware == Firmware::ardupilot) o.autopilot.unhealthy = "magnetometer transmitter";
      Texts failed;
      fly(
          std::string("checks_") + name_of(firmware), o,
          [&](AutopilotVehicle& v, Phase, TimeNs now) {
            if (now != 8 * kSecond) return;
            const auto checks = v.checks();
            EXPECT_GT(checks.size(), 14u);
            for (const VehicleCheck& c : checks)
              if (!c.holds) failed.push_back(c.name + " " + c.found);
          },
          1, 9);
      if (right)
        EXPECT_EQ(failed, Texts{});
      else if (firmware == Firmware::px4)
        EXPECT_EQ(failed, (Texts{"COM_OF_LOSS_T 5", "EKF2_EV_CTRL 0"}));
      else
        EXPECT_EQ(failed, (Texts{"FS_GCS_ENABLE 1", "sensors' health unhealthy: magnetometer",
                                 "transmitter not heard"}));
    }
}

TEST(MavlinkControl, ByRatesOverALinkOfFiveMilliseconds) {
  AutopilotVehicleOptions o = usual(Firmware::px4);
  o.link.latency_s = 0.005, o.link.jitter_s = 0.001;
  o.mavlink.control = Control::rates;
  o.mavlink.setpoint_rate_hz = 100;
  expect_landed(fly("rates", o));
}

}  // namespace
}  // namespace karst::core
