// Whole missions of a vehicle that needs no simulator, by a policy that does as the test says.
#include "core_stack/mission/mission_control.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <utility>

#include "core_stack/common/json_text.h"
#include "tests/unit/mission/fake_vehicle.h"
#include "tests/unit/mission/scripted_policy.h"

namespace karst::core {
namespace {

const Vec3 kStart(0, 0, 0.2);
constexpr double kFar_m = 14;  // as far as the corridor can be flown
constexpr char kDegraded[] = "slow: the state estimate is degraded: a measurement that is not a number";
using Texts = std::vector<std::string>;

/// A room that leads into a corridor along x.
std::vector<Room> room_with_corridor() {
  return {{Vec3(-3, -3, 0), Vec3(4, 3, 3.2)}, {Vec3(3, -1.4, 0), Vec3(kFar_m + 2, 1.4, 2.8)}};
}

Decision fly_to(double x_m) {
  Decision decision;
  decision.outcome = Outcome::goals;
  Goal goal;
  goal.position = Vec3(x_m, 0, 1.3);
  goal.heading_rad = std::numeric_limits<double>::quiet_NaN();
  decision.goals = {goal};
  return decision;
}

Decision explored() {
  Decision decision;
  decision.outcome = Outcome::explored;
  decision.reason = "all seen";
  return decision;
}

class MissionControlTest : public ::testing::Test {
 protected:
  MissionControlTest() {
    options.localization.source = PoseSource::pose_sensor;
    options.map.resolution_m = 0.4;                                      // ample for a few rays
    policy.script = [there = false](const DecisionRequest& r) mutable {  // to and fro
      const double x_m = r.state.position.x();
      if (x_m > kFar_m - 1 || x_m < 3) there = x_m < 3;
      return fly_to(there ? kFar_m : 2);
    };
    std::filesystem::remove_all(run);
  }

  /// Flies the mission; `in_flight` is called ten times a second.
  MissionResult fly(
      const std::function<void(MissionControl&)>& in_flight = [](MissionControl&) {},
      const Watch& watch = [](const MissionStatus&) { return true; }) {
    Recorder recorder(run);
    MissionControl mission(options, vehicle, executive, policy, recorder);
    executive.every("test", 100 * kMillisecond, 100 * kMillisecond, [&] { in_flight(mission); });
    MissionResult result = mission.run(watch);
    recorder.flush();
    std::ifstream in(run / "events.jsonl");
    for (std::string line; std::getline(in, line);) events.push_back(json_of(line));
    return result;
  }
  /// A measurement that is not a number: the vehicle still flies well by all others.
  void degrade(MissionControl& mission) const {
    mission.on_barometer({executive.now(), std::numeric_limits<double>::quiet_NaN()});
  }

  /// Of the events of that kind, one field, or two with a colon between them.
  Texts told(const std::string& kind, const std::string& field, const std::string& other = "") const {
    Texts out;
    for (const nlohmann::json& e : events) {
      if (e["kind"] != kind) continue;
      out.push_back(e[field].get<std::string>());
      if (!other.empty()) out.back() += ": " + e[other].get<std::string>();
    }
    return out;
  }
  Texts phases() const { return told("phase", "phase"); }
  Texts safety() const { return told("safety", "action", "reason"); }
  std::string homing_reason() const {
    for (const nlohmann::json& e : events)
      if (e["kind"] == "phase" && e["phase"] == "home") return e["reason"];
    return "it never went home";
  }

  const std::filesystem::path run =
      std::filesystem::path(KARST_BINARY_DIR) / "test_runs" /
      (std::string("mission_control_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
  CoreOptions options;
  FakeVehicle vehicle{room_with_corridor(), kStart};
  Executive executive{1};
  ScriptedPolicy policy;
  std::vector<nlohmann::json> events;
};

const Texts kWholeMission{"standby", "takeoff", "explore", "home", "land", "done"};
const Texts kCutShort{"standby", "takeoff", "explore", "land", "done"};

// As it was: the mission was over, and the last command still had the motors climb.
TEST_F(MissionControlTest, ThatDoesNotLiftOffEndsWithTheMotorsOff) {
  vehicle.load_kg = 100;
  EXPECT_EQ(fly().outcome, MissionOutcome::stuck);
  EXPECT_FALSE(vehicle.commanded().armed);
}

TEST_F(MissionControlTest, ExploresAsThePolicySaysComesHomeAndLandsAtTheStart) {
  const std::vector<Decision> script{fly_to(5), fly_to(9), explored()};
  std::size_t asked = 0;
  policy.script = [&](const DecisionRequest&) { return script[std::min(asked++, script.size() - 1)]; };
  options.motion.trajectory = TrajectoryKind::sampled;  // it looks at nothing beyond the goals
  options.mission.append = false;                       // a goal is reached before the next is asked for
  options.mission.decision_period_s = 600;
  double farthest_m = 0;
  const MissionResult result =
      fly([&](MissionControl&) { farthest_m = std::max(farthest_m, vehicle.pose().position.x()); });
  EXPECT_EQ(result.outcome, MissionOutcome::landed);
  EXPECT_EQ(result.reason, "at the start");
  EXPECT_TRUE(result.stands);
  EXPECT_EQ(result.record_problem, "");
  EXPECT_EQ(phases(), kWholeMission);
  EXPECT_EQ(homing_reason(), "explored: all seen");
  EXPECT_EQ(safety(), Texts{});
  EXPECT_NEAR(farthest_m, 9, 0.5);
  EXPECT_NEAR((vehicle.pose().position - kStart).norm(), 0, 0.3);

  using Kind = PolicyEvent::Kind;
  std::vector<Kind> heard;
  for (const PolicyEvent& e : policy.heard) heard.push_back(e.kind);
  EXPECT_EQ(heard, (std::vector{Kind::goal_reached, Kind::goal_reached, Kind::homing}));
}

// As it was: a policy that once had no goal ended the mission.
TEST_F(MissionControlTest, ExploresOnWhenThePolicySaidExploredOnce) {
  const std::vector<Decision> script{fly_to(5), explored(), fly_to(9), explored()};
  std::size_t asked = 0;
  policy.script = [&](const DecisionRequest&) { return script[std::min(asked++, script.size() - 1)]; };
  options.motion.trajectory = TrajectoryKind::sampled;
  options.mission.append = false;
  options.mission.decision_period_s = 600;
  double farthest_m = 0;
  fly([&](MissionControl&) { farthest_m = std::max(farthest_m, vehicle.pose().position.x()); });
  EXPECT_EQ(phases(), kWholeMission);
  EXPECT_EQ(homing_reason(), "explored: all seen");
  EXPECT_NEAR(farthest_m, 9, 0.5);
}

TEST_F(MissionControlTest, NowExploredAndNowAGoalExploresUntilTheBatterySendsItHome) {
  vehicle.battery_s = 70;
  policy.script = [on = policy.script, asked = 0](const DecisionRequest& r) mutable {
    return ++asked % 2 == 1 ? explored() : on(r);
  };
  EXPECT_EQ(fly().outcome, MissionOutcome::landed);
  EXPECT_EQ(phases(), kWholeMission);
  EXPECT_FALSE(homing_reason().starts_with("explored")) << homing_reason();
  EXPECT_NE(homing_reason().find("battery"), std::string::npos) << homing_reason();
}

TEST_F(MissionControlTest, WithoutPatienceTheFirstExploredSendsItHome) {
  options.mission.explored_patience_s = 0;
  policy.script = [](const DecisionRequest&) { return explored(); };
  EXPECT_EQ(fly().outcome, MissionOutcome::landed);
  EXPECT_LE(told("decision", "outcome").size(), 2u);
}

TEST_F(MissionControlTest, APolicyThatHasNothingForFiveSecondsSendsItHomeFromItsHover) {
  policy.script = [](const DecisionRequest&) { return explored(); };
  EXPECT_EQ(fly().outcome, MissionOutcome::landed);
  EXPECT_EQ(phases(), kWholeMission);
  EXPECT_EQ(homing_reason(), "explored: all seen");
  const Texts by = told("decision", "policy");
  EXPECT_GT(by.size(), 10u) << "it is asked again every 0.4 s";
  EXPECT_EQ(std::count(by.begin(), by.end(), "scripted"), static_cast<std::ptrdiff_t>(by.size()));
  std::vector<double> decided_s, homed_s;
  for (const nlohmann::json& e : events) {
    if (e["kind"] == "decision") decided_s.push_back(e["t"].get<double>());
    if (e["kind"] == "phase" && e["phase"] == "home") homed_s.push_back(e["t"].get<double>());
  }
  ASSERT_EQ(homed_s.size(), 1u);
  EXPECT_GT(homed_s.front() - decided_s.front(), 4.99);
  EXPECT_LT(homed_s.front() - decided_s.front(), 6);
  ASSERT_EQ(policy.heard.size(), 1u);
  EXPECT_EQ(policy.heard.front().kind, PolicyEvent::Kind::homing);
}

TEST_F(MissionControlTest, TurnsBackWhileTheBatteryLastsForTheWayHome) {
  vehicle.battery_s = 55;
  options.mission.append = false;
  options.mission.decision_period_s = 600;
  policy.script = [](const DecisionRequest&) {
    Decision slowly = fly_to(kFar_m);  // it takes longer than was reckoned with
    slowly.goals.front().max_speed_mps = 0.5;
    return slowly;
  };
  EXPECT_EQ(fly().outcome, MissionOutcome::landed);
  EXPECT_EQ(phases(), kWholeMission);
  EXPECT_EQ(homing_reason(), "the battery only just suffices for the way home");
  EXPECT_EQ(told("homing", "reason"), Texts{"battery"});
  EXPECT_NEAR(vehicle.battery_s, options.mission.home_reserve_s, 5);
}

TEST_F(MissionControlTest, LandsWhereItIsWhenTheOperatorEndsTheFlight) {
  const MissionResult result =
      fly([](MissionControl&) {}, [this](const MissionStatus&) { return vehicle.pose().position.x() < 5; });
  EXPECT_EQ(result.outcome, MissionOutcome::aborted);
  EXPECT_TRUE(result.reason.starts_with("stopped by the operator: on the ground ")) << result.reason;
  EXPECT_TRUE(result.stands);
  EXPECT_EQ(phases(), kCutShort);
  EXPECT_EQ(safety(), Texts{"land: stopped by the operator"});
  EXPECT_GT(vehicle.pose().position.x(), 5);
}

TEST_F(MissionControlTest, LandsWhereItIsWhenTheEstimateIsLost) {
  const MissionResult result =
      fly([this](MissionControl&) { vehicle.pose_sensor_works &= vehicle.pose().position.x() < 5; });
  EXPECT_EQ(result.outcome, MissionOutcome::stuck);
  EXPECT_TRUE(result.reason.starts_with("on the ground ")) << result.reason;
  EXPECT_TRUE(result.stands);
  EXPECT_EQ(phases(), kCutShort);
  EXPECT_EQ(safety(), (Texts{"slow: the state estimate is degraded: no pose",
                             "land: the state estimate is lost: no pose for too long"}));
}

TEST_F(MissionControlTest, LandsByItsCommandsAndPosesWhenTheImuStops) {
  const MissionResult result =
      fly([this](MissionControl&) { vehicle.imu_works &= vehicle.pose().position.x() < 5; });
  EXPECT_EQ(result.outcome, MissionOutcome::stuck);
  EXPECT_TRUE(result.stands);
  EXPECT_EQ(phases(), kCutShort);
  EXPECT_EQ(safety(), (Texts{"slow: the state estimate is degraded: no IMU",
                             "land: the state estimate is lost: no IMU for too long"}));
}

TEST_F(MissionControlTest, IsOverWhenTheVehicleHitsRock) {
  const MissionResult result =
      fly([this](MissionControl&) { vehicle.wind_push_mps2.y() = vehicle.pose().position.x() < 5 ? 0 : 20; });
  EXPECT_EQ(result.outcome, MissionOutcome::contact);
  EXPECT_EQ(result.reason, "touched rock");
  EXPECT_FALSE(result.stands);
  EXPECT_EQ(phases(), (Texts{"standby", "takeoff", "explore", "done"}));
}

TEST_F(MissionControlTest, IgnoresSensorMessagesFromTheFuture) {
  vehicle.battery_s = 40;
  options.motion.trajectory = TrajectoryKind::sampled;
  bool scanned =
      false;  // once: of two scans in turn that need the same correction the clock is taken to be set
  const MissionResult result = fly([&](MissionControl& mission) {
    const TimeNs later = executive.now() + 3600 * kSecond;
    const Vec3 nonsense(7, -7, 7);
    mission.on_imu({later, nonsense, nonsense});
    mission.on_magnetometer({later, nonsense});
    mission.on_barometer({later, 7});
    mission.on_pose({later, {nonsense, Quat::Identity()}});
    if (mission.phase() != Phase::explore || std::exchange(scanned, true)) return;
    LidarScan scan;
    scan.stamp = later;
    scan.model = vehicle.description().lidar;
    scan.range_m.assign(scan.model->elevation_rad.size() * static_cast<std::size_t>(scan.model->columns),
                        0.7f);
    scan.intensity.assign(scan.range_m.size(), 0.5f);
    mission.on_lidar(std::make_shared<LidarScan>(scan));
  });
  EXPECT_TRUE(scanned);
  EXPECT_EQ(result.outcome, MissionOutcome::landed);
  EXPECT_EQ(phases(), kWholeMission);
  EXPECT_EQ(safety(), Texts{});
  EXPECT_NEAR((vehicle.pose().position - kStart).norm(), 0, 0.3);
}

TEST_F(MissionControlTest, ComesHomeWhenTheDiskIsFullAndSaysThatTheRecordIsIncomplete) {
  std::filesystem::create_directories(run);
  std::filesystem::create_symlink("/dev/full", run / "telemetry.csv");
  const MissionResult result = fly();
  EXPECT_EQ(result.outcome, MissionOutcome::landed);
  EXPECT_EQ(phases(), kWholeMission);
  EXPECT_EQ(homing_reason(), "the run directory cannot be written any more (disk full?)");
  EXPECT_NE(result.record_problem, "");
}

TEST_F(MissionControlTest, GoesHomeSlowlyWhenTheEstimateStaysDegraded) {
  options.safety.degraded_home_s = 2;
  EXPECT_EQ(fly([this](MissionControl& mission) {
              if (mission.phase() == Phase::explore && vehicle.pose().position.x() > 3) degrade(mission);
            }).outcome,
            MissionOutcome::landed);
  EXPECT_EQ(phases(), kWholeMission);
  EXPECT_EQ(homing_reason(), "the state estimate stays degraded");
  EXPECT_EQ(safety(), (Texts{kDegraded, "home: the state estimate stays degraded", "none: "}));
}

TEST_F(MissionControlTest, BrakesWhenBlindAndThenGoesHomeThroughTheKnownMap) {
  options.safety.blind_home_s = 3;
  EXPECT_EQ(fly([this](MissionControl&) { vehicle.lidar_works &= vehicle.pose().position.x() < 5; }).outcome,
            MissionOutcome::landed);
  EXPECT_EQ(phases(), kWholeMission);
  EXPECT_EQ(homing_reason(), "no sensor sees the cave any more");
  EXPECT_EQ(safety(), (Texts{"brake: no sensor sees the cave", "home: no sensor sees the cave any more"}));
}

// As it was: found again within a second, the pose was lost again by the action that outlived its cause, and
// the vehicle landed in the cave for good.
TEST_F(MissionControlTest, APoseThatIsLostAndSoonFoundAgainBreaksTheLandingOff) {
  std::optional<TimeNs> lost;
  const MissionResult result = fly([&](MissionControl& mission) {
    if (mission.phase() == Phase::explore && vehicle.pose().position.x() > 5 && !lost) lost = executive.now();
    vehicle.pose_sensor_works = !lost || mission.phase() != Phase::explore;  // back as soon as it lands
  });
  ASSERT_TRUE(lost.has_value()) << "it never came so far: this shows nothing";
  EXPECT_EQ(homing_reason(), "the pose is known again");
  EXPECT_EQ(result.outcome, MissionOutcome::landed);
  EXPECT_EQ(phases(), (Texts{"standby", "takeoff", "explore", "land", "home", "land", "done"}));
}

TEST_F(MissionControlTest, AnEstimateDegradedSinceTakeOffSendsItHome) {
  options.safety.degraded_home_s = 1;
  EXPECT_EQ(fly([this](MissionControl& mission) { degrade(mission); }).outcome, MissionOutcome::landed);
  EXPECT_EQ(phases(), kWholeMission);
  EXPECT_EQ(homing_reason(), "the state estimate stays degraded");
  EXPECT_EQ(safety(), (Texts{kDegraded, "home: the state estimate stays degraded"}));
}

TEST_F(MissionControlTest, BlindSinceTakeOffItGoesHome) {
  options.safety.blind_home_s = 2;
  vehicle.lidar_works = false;
  EXPECT_EQ(fly().outcome, MissionOutcome::landed);
  EXPECT_EQ(phases(), kWholeMission);
  EXPECT_EQ(homing_reason(), "no sensor sees the cave any more");
}

TEST_F(MissionControlTest, SlowedSinceTakeOffItExploresSlowlyUntilTheCauseIsGone) {
  options.safety.degraded_home_s = 600;
  vehicle.battery_s = 45;
  double slowly_mps = 0, then_mps = 0;
  fly([&](MissionControl& mission) {
    const bool degraded = executive.now() < 8 * kSecond;
    if (degraded) degrade(mission);
    double& fastest_mps = degraded ? slowly_mps : then_mps;
    fastest_mps = std::max(fastest_mps, vehicle.velocity_mps().norm());
  });
  const double slow_mps = options.safety.slow_fraction * options.motion.max_speed_mps;
  EXPECT_EQ(safety(), (Texts{kDegraded, "none: "}));
  EXPECT_LT(slowly_mps, 1.1 * slow_mps);
  EXPECT_GT(slowly_mps, 0.7 * slow_mps);
  EXPECT_GT(then_mps, 1.5 * slow_mps);
}

TEST_F(MissionControlTest, BrakesForWhatPushesItOffItsPathOnTheWayHomeWithADegradedEstimate) {
  options.safety.degraded_home_s = 2;
  std::optional<TimeNs> pushed;
  bool degraded = false;
  EXPECT_EQ(fly([&](MissionControl& mission) {
              degraded |= vehicle.pose().position.x() > 7;
              if (degraded) degrade(mission);
              if (mission.phase() == Phase::home && !pushed) pushed = executive.now();
              const TimeNs since = executive.now() - pushed.value_or(executive.now());
              vehicle.wind_push_mps2 = {since > kSecond && since < 2 * kSecond ? 9.0 : 0.0, 0, 0};
            }).outcome,
            MissionOutcome::landed);
  EXPECT_EQ(phases(), kWholeMission);
  EXPECT_EQ(homing_reason(), "the state estimate stays degraded");
  const Texts all = safety();
  EXPECT_EQ(std::count(all.begin(), all.end(), "brake: far from the reference"), 1);
}

/// As an autopilot in a hold, or at a speed: against gravity, braking.
AttitudeRateCommand hold(const FakeVehicle& vehicle, const Vec3& wanted_mps = Vec3::Zero()) {
  const Vec3 tilt = vehicle.pose().orientation * Vec3::UnitZ();
  const Vec3 to = (Vec3(0, 0, 9.81) - 2 * (vehicle.velocity_mps() - wanted_mps)).normalized();
  return {6 * (vehicle.pose().orientation.conjugate() * tilt.cross(to)),
          vehicle.description().mass_kg * (9.81 - 2 * (vehicle.velocity_mps() - wanted_mps).z()) / tilt.z(),
          true};
}

TEST_F(MissionControlTest, WaitsForThePilotAndTheTimeAllowedCountsFromThen) {
  options.mission.max_flight_time_s = 40;
  vehicle.battery_s = 1e4;
  vehicle.steered_by(Authority::pilot);
  const MissionResult result = fly([&](MissionControl& mission) {
    if (executive.now() == 700 * kSecond)
      mission.on_authority(executive.now(), Authority::core, "handed over");
    if (executive.now() < 700 * kSecond) {
      EXPECT_EQ(mission.phase(), Phase::standby);
    }
  });
  EXPECT_EQ(result.outcome, MissionOutcome::landed);
  EXPECT_EQ(phases(), kWholeMission);
  EXPECT_EQ(told("authority", "who", "reason"), Texts{"core: handed over"});
  EXPECT_GT(executive.now(), 710 * kSecond);
  EXPECT_LT(executive.now(), 760 * kSecond);
}

TEST_F(MissionControlTest, ThePilotTakesOverAndGivesBackWhileExploringAndOnTheWayHome) {
  vehicle.battery_s = 90;
  TimeNs taken = 0;
  int times = 0;
  double farthest_off_m = 0;
  const MissionResult result = fly([&](MissionControl& mission) {
    const TimeNs now = executive.now();
    const bool first = times == 0 && mission.phase() == Phase::explore && vehicle.pose().position.x() > 6;
    const bool second = times == 1 && mission.phase() == Phase::home && vehicle.velocity_mps().norm() > 0.5;
    if (first || second) {
      taken = now;
      ++times;
      vehicle.pilot_rates = hold(vehicle);
      mission.on_authority(now, Authority::pilot, "mode stabilized");
    }
    if (!vehicle.pilot_rates) return;
    EXPECT_EQ(mission.phase(), Phase::manual);
    vehicle.pilot_rates = hold(vehicle);
    farthest_off_m =
        std::max(farthest_off_m, (vehicle.told().reference.position - vehicle.pose().position).norm());
    if (now - taken < 5 * kSecond) return;
    vehicle.pilot_rates.reset();
    mission.on_authority(now, Authority::core, "mode offboard");
  });
  EXPECT_EQ(result.outcome, MissionOutcome::landed);
  EXPECT_EQ(result.reason, "at the start");
  EXPECT_EQ(times, 2);
  EXPECT_EQ(phases(), (Texts{"standby", "takeoff", "explore", "manual", "explore", "home", "manual", "home",
                             "land", "done"}));
  EXPECT_LT(farthest_off_m, 0.5) << "the reference stays with the vehicle";
}

// As it was: it set out for its hover first, sagged in the first moment, and the ground touched it as a
// contact.
TEST_F(MissionControlTest, TakenFromTheCoreJustAboveTheGroundItLandsOn) {
  TimeNs taken = 0;
  const MissionResult result = fly([&](MissionControl& mission) {
    const TimeNs now = executive.now();
    if (taken == 0 && mission.phase() == Phase::land && vehicle.velocity_mps().z() < -0.2) {
      taken = now;
      mission.on_authority(now, Authority::autopilot, "no heartbeat");
    }
    if (taken == now) return;
    if (taken == 0 || mission.phase() != Phase::manual) return;
    vehicle.pilot_rates = hold(vehicle);
    if (now - taken < 5 * kSecond) return;
    vehicle.pilot_rates.reset();
    mission.on_authority(now, Authority::core, "mode guided");
  });
  EXPECT_EQ(result.outcome, MissionOutcome::landed) << result.reason;
  EXPECT_EQ(phases(), (Texts{"standby", "takeoff", "explore", "home", "land", "manual", "land", "done"}));
}

TEST_F(MissionControlTest, ThePilotTakesOffSetsItDownTakesOffAgainAndHandsOverInTheAir) {
  vehicle.steered_by(Authority::pilot);
  const auto flies = [&](double climb_mps) {
    vehicle.pilot_rates = hold(vehicle);
    vehicle.pilot_rates->thrust_n += vehicle.description().mass_kg * 2 * climb_mps;
  };
  const MissionResult result = fly([&](MissionControl& mission) {
    const double t = seconds(executive.now());
    if (t < 3) return;
    if (t < 5) return flies(0.5);
    if (t < 9) return flies(-0.5);  // on the ground at 7 s
    if (t < 10) {
      EXPECT_EQ(mission.phase(), Phase::standby);
      return flies(-0.5);
    }
    if (t < 12) return flies(0.5);
    if (vehicle.pilot_rates) {
      EXPECT_EQ(mission.phase(), Phase::manual);
      vehicle.pilot_rates.reset();
      mission.on_authority(executive.now(), Authority::core, "mode offboard");
    }
  });
  EXPECT_EQ(result.outcome, MissionOutcome::landed) << result.reason;
  EXPECT_EQ(phases(), (Texts{"standby", "manual", "standby", "manual", "explore", "home", "land", "done"}));
}

// As it was: the core neither took over nor came down, and commanded a hover for ever.
TEST_F(MissionControlTest, AnEmergencyWhileThePilotSteersLandsWhenTheCoreSteersAgain) {
  TimeNs taken = 0;
  const MissionResult result = fly([&](MissionControl& mission) {
    const TimeNs now = executive.now();
    if (taken == 0 && mission.phase() == Phase::explore && vehicle.pose().position.x() > 5) {
      taken = now;
      mission.on_authority(now, Authority::pilot, "mode stabilized");
    }
    if (taken == 0) return;
    vehicle.pilot_rates = hold(vehicle);
    if (now - taken == 2 * kSecond) mission.land_now("a failure");
    if (now - taken < 6 * kSecond) {
      EXPECT_LT((vehicle.told().reference.position - vehicle.pose().position).norm(), 0.5);
      return;
    }
    vehicle.pilot_rates.reset();
    mission.on_authority(now, Authority::core, "mode offboard");
  });
  EXPECT_EQ(result.outcome, MissionOutcome::aborted);
  EXPECT_TRUE(result.reason.starts_with("a failure: on the ground")) << result.reason;
  EXPECT_TRUE(result.stands);
}

// As it was: the next hand-over began to explore on the ground, or took the first one's braking for a roof.
TEST_F(MissionControlTest, TakenFromTheCoreBeforeItLiftsOffWaitsOnTheGroundAndTakesOffAgain) {
  bool taken = false;
  vehicle.load_kg = 100;
  const MissionResult result = fly([&](MissionControl& mission) {
    if (!taken && mission.phase() == Phase::takeoff) {
      taken = true;
      vehicle.load_kg = 0;
      vehicle.pilot_rates = AttitudeRateCommand{};
      mission.on_authority(executive.now(), Authority::pilot, "disarmed");
      EXPECT_EQ(mission.phase(), Phase::standby);
    }
    if (vehicle.pilot_rates && executive.now() > 10 * kSecond) {
      vehicle.pilot_rates.reset();
      mission.on_authority(executive.now(), Authority::core, "armed, mode offboard");
    }
  });
  EXPECT_EQ(result.outcome, MissionOutcome::landed) << result.reason;
  EXPECT_EQ(phases(),
            (Texts{"standby", "takeoff", "manual", "standby", "takeoff", "explore", "home", "land", "done"}));
  EXPECT_EQ(told("log", "text"), Texts{});
}

// As it was: thrust 0, which an autopilot flies that is switched to the core.
TEST_F(MissionControlTest, WhileThePilotFliesBeforeTheFirstHandOverTheCommandIsAHover) {
  vehicle.steered_by(Authority::pilot);
  bool watched = false;
  fly([&](MissionControl& mission) {
    const double t = seconds(executive.now());
    if (t < 3) {
      EXPECT_FALSE(vehicle.told().rates.armed);
      return;
    }
    if (t < 8) {
      vehicle.pilot_rates = hold(vehicle);
      if (t < 5) vehicle.pilot_rates->thrust_n += 2;
      if (t < 4) return;
      watched = true;
      EXPECT_TRUE(vehicle.told().rates.armed);
      EXPECT_NEAR(vehicle.told().rates.thrust_n, 9.81 * vehicle.description().mass_kg, 0.5);
      return;
    }
    if (!vehicle.pilot_rates) return;
    vehicle.pilot_rates.reset();
    mission.on_authority(executive.now(), Authority::core, "mode offboard");
  });
  EXPECT_TRUE(watched);
}

TEST_F(MissionControlTest, DoesNotTakeOffBeforeTheVehiclesChecksHold) {
  vehicle.checked = {{"COM_OF_LOSS_T", "at most 1 s", "5 s", false}, {"heartbeat", "comes", "comes", true}};
  fly([&](MissionControl& mission) {
    if (executive.now() < 20 * kSecond) {
      EXPECT_EQ(mission.phase(), Phase::standby);
    }
    if (executive.now() >= 20 * kSecond) vehicle.checked.front().holds = true;
  });
  EXPECT_EQ(phases(), kWholeMission);
  EXPECT_EQ(told("log", "text"),
            Texts{"it waits on the ground: COM_OF_LOSS_T must be at most 1 s, and is 5 s"});
}

// The terminal said "standby" alone.
TEST_F(MissionControlTest, TellsItsOperatorWhatItWaitsFor) {
  vehicle.steered_by(Authority::pilot);
  vehicle.checked = {{"COM_OF_LOSS_T", "at most 1 s", "5 s", false}};
  Texts waits;
  fly(
      [&](MissionControl& mission) {
        const TimeNs now = executive.now();
        if (now == kSecond / 2) mission.on_authority(now, Authority::pilot, "no autopilot yet at udp:14540");
        if (now == 5 * kSecond) mission.on_authority(now, Authority::pilot, "not armed");
        if (now == 10 * kSecond) mission.on_authority(now, Authority::core, "mode offboard");
        if (now == 15 * kSecond) vehicle.checked.front().holds = true;
        if (now == 25 * kSecond) {
          vehicle.pilot_rates = hold(vehicle);
          mission.on_authority(now, Authority::pilot, "mode stabilized");
        }
        if (vehicle.pilot_rates) vehicle.pilot_rates = hold(vehicle);
        if (now == 28 * kSecond) {
          vehicle.pilot_rates.reset();
          mission.on_authority(now, Authority::core, "mode offboard");
        }
      },
      [&](const MissionStatus& status) {
        if (waits.empty() || waits.back() != status.waits_for) waits.push_back(status.waits_for);
        return true;
      });
  EXPECT_EQ(waits, (Texts{"waits: no autopilot yet at udp:14540", "waits: not armed",
                          "waits: COM_OF_LOSS_T must be at most 1 s, and is 5 s", "",
                          "the pilot steers: mode stabilized", ""}));
}

// It was counted as full.
TEST_F(MissionControlTest, ABatteryThatHasSaidNothingIsUnknown) {
  vehicle.battery_speaks = false;
  options.mission.max_flight_time_s = 60;
  const MissionResult result =
      fly([](MissionControl&) {}, [](const MissionStatus& status) { return !status.battery; });
  EXPECT_EQ(result.outcome, MissionOutcome::landed) << result.reason;
  std::ifstream in(run / "telemetry.csv");
  std::string head, row;
  std::getline(in, head);
  std::getline(in, row);
  EXPECT_NE(row.find(",nan,nan,"), std::string::npos) << row;
}

TEST_F(MissionControlTest, LandedByTheAutopilotIsAborted) {
  bool failsafe = false;
  const MissionResult result = fly([&](MissionControl& mission) {
    if (!failsafe && mission.phase() == Phase::explore && vehicle.pose().position.x() > 4) {
      failsafe = true;
      mission.on_authority(executive.now(), Authority::autopilot, "battery failsafe: land");
    }
    if (!failsafe) return;
    vehicle.pilot_rates = hold(vehicle);
    vehicle.pilot_rates->thrust_n -= vehicle.description().mass_kg * 2 * 0.5;  // comes down at 0.5 m/s
  });
  EXPECT_EQ(result.outcome, MissionOutcome::aborted);
  EXPECT_TRUE(result.reason.starts_with("landed by the autopilot")) << result.reason;
  EXPECT_TRUE(result.stands);
  EXPECT_EQ(phases(), (Texts{"standby", "takeoff", "explore", "manual", "done"}));
  EXPECT_FALSE(vehicle.told().rates.armed);
}

/// Of the corridor, up to x = 9.
std::shared_ptr<const FlightRegion> part_of_the_corridor() {
  FlightRegion::Limits limits;
  limits.keep_in = box({-5, -5, -2}, {9, 5, 6});
  limits.margin_m = 0.5;
  return std::make_shared<const FlightRegion>(limits);
}

TEST_F(MissionControlTest, FliesToNoGoalOutsideItsRegionAndSaysWhy) {
  options.region = part_of_the_corridor();
  vehicle.battery_s = 60;
  policy.script = [](const DecisionRequest&) {
    Decision both = fly_to(kFar_m);
    both.goals.push_back(fly_to(7).goals.front());
    return both;
  };
  double farthest_m = 0;
  std::set<std::string> reasons;
  const MissionResult result =
      fly([&](MissionControl&) { farthest_m = std::max(farthest_m, vehicle.pose().position.x()); });
  for (const PolicyEvent& e : policy.heard)
    if (e.kind == PolicyEvent::Kind::goal_rejected) reasons.insert(e.reason);
  EXPECT_EQ(result.outcome, MissionOutcome::landed);
  EXPECT_EQ(phases(), kWholeMission);
  EXPECT_GT(farthest_m, 6.5);
  EXPECT_LT(farthest_m, 9 - vehicle.description().radius_m);
  EXPECT_TRUE(reasons.contains("it lies outside region.keep_in"));
}

TEST_F(MissionControlTest, BlownOutOfItsRegionItFliesBackInsideAndHome) {
  options.region = part_of_the_corridor();
  policy.script = [](const DecisionRequest& r) { return fly_to(r.state.position.x() > 5 ? 2 : 7); };
  std::optional<TimeNs> pushed;
  double farthest_m = 0;
  const MissionResult result = fly([&](MissionControl& mission) {
    farthest_m = std::max(farthest_m, vehicle.pose().position.x());
    if (mission.phase() == Phase::explore && vehicle.pose().position.x() > 6 && !pushed)
      pushed = executive.now();
    vehicle.wind_push_mps2 = {pushed && farthest_m < 8.5 ? 11.0 : 0.0, 0, 0};
  });
  EXPECT_EQ(result.outcome, MissionOutcome::landed);
  EXPECT_EQ(phases(), kWholeMission);
  EXPECT_GT(farthest_m, 9);
  EXPECT_EQ(homing_reason(), "the vehicle is outside region.keep_in");
  EXPECT_NEAR((vehicle.pose().position - kStart).norm(), 0, 0.3);
}

TEST_F(MissionControlTest, HandedOverOutsideItsRegionItFliesBackInsideAndHome) {
  options.region = part_of_the_corridor();
  policy.script = [](const DecisionRequest& r) { return fly_to(r.state.position.x() > 5 ? 2 : 7); };
  bool over = false;
  const MissionResult result = fly([&](MissionControl& mission) {
    if (over) return;
    if (!vehicle.pilot_rates && mission.phase() == Phase::explore && vehicle.pose().position.x() > 6)
      mission.on_authority(executive.now(), Authority::pilot, "mode stabilized");
    if (mission.phase() != Phase::manual) return;
    const bool flies_on = vehicle.pose().position.x() < 11;
    vehicle.pilot_rates = hold(vehicle, Vec3(flies_on ? 1 : 0, -0.3 * vehicle.pose().position.y(), 0));
    if (flies_on || vehicle.velocity_mps().norm() > 0.1) return;
    over = true;
    vehicle.pilot_rates.reset();
    mission.on_authority(executive.now(), Authority::core, "mode offboard");
  });
  EXPECT_TRUE(over);
  EXPECT_EQ(result.outcome, MissionOutcome::landed);
  EXPECT_EQ(phases(), (Texts{"standby", "takeoff", "explore", "manual", "explore", "home", "land", "done"}));
  EXPECT_EQ(homing_reason(), "the vehicle is outside region.keep_in");
  EXPECT_EQ(told("safety", "reason").front(), "the vehicle is outside region.keep_in");
  EXPECT_NEAR((vehicle.pose().position - kStart).norm(), 0, 0.3);
}

// As it was: home was where it was handed over, and it landed there, outside.
TEST_F(MissionControlTest, ThatAPilotTookOffAndHandedOverOutsideItsRegionFliesHomeToItsStart) {
  options.region = part_of_the_corridor();
  vehicle.steered_by(Authority::pilot);
  bool over = false;
  const MissionResult result = fly([&](MissionControl& mission) {
    if (over || executive.now() < 3 * kSecond) return;
    const bool low = vehicle.pose().position.z() < kStart.z() + 1;
    const bool flies_on = vehicle.pose().position.x() < 11;
    const double y = vehicle.pose().position.y();
    vehicle.pilot_rates = hold(vehicle, Vec3(flies_on && !low ? 1 : 0, -0.3 * y, low ? 0.5 : 0));
    if (flies_on || vehicle.velocity_mps().norm() > 0.1) return;
    over = true;
    vehicle.pilot_rates.reset();
    mission.on_authority(executive.now(), Authority::core, "mode offboard");
  });
  EXPECT_TRUE(over);
  EXPECT_EQ(result.outcome, MissionOutcome::landed) << result.reason;
  EXPECT_EQ(homing_reason(), "the vehicle is outside region.keep_in");
  EXPECT_NEAR((vehicle.pose().position - kStart).norm(), 0, 0.3);
}

}  // namespace
}  // namespace karst::core
