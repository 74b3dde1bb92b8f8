// Whatever fails in the air, and whenever the operator ends the flight: the vehicle brakes and lands where it
// is, touching nothing on the way. Each fault strikes a flight through a cave at 1.5 m/s or more.
#include <cstdlib>
#include <new>

#include "core_stack/mission/mission_control.h"
#include "core_stack/team/communication/mission_key.h"
#include "core_stack/team/relay_homing.h"
#include "plugins/simulator/cave_generator/generate_cave.h"
#include "plugins/simulator/simulated_vehicle.h"
#include "tests/closed_loop/command.h"
#include "tests/closed_loop/drawn_cave.h"
#include "tests/closed_loop/tourist.h"

namespace {
thread_local bool out_of_memory = false;
}

// The other forms of new and delete come to these. Inlined, g++ sees only that free() ends what new began,
// and warns
// (-Wmismatched-new-delete).
[[gnu::noinline]] void* operator new(std::size_t size) {
  void* const p = out_of_memory ? nullptr : std::malloc(size);
  return p ? p : throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace karst::core {
namespace {

constexpr double kFast_mps = 1.5;
constexpr char kText[] = "struck by the test";

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

/// A hall whose roof comes down to 2.4 m while the vehicle takes off.
const cave::Cave& falling_roof() {
  static const cave::Cave low = [] {
    const std::string cave =
        draw_cave(fresh_folder("emergency_roof"), {{{-6, -4, 0}, {6, 4, 5}}}, {0, 0, 0.5});
    std::ofstream(cave, std::ios::app) << "boulder { position \"0 0 3.4\" radius \"1 m\" after \"1 s\" }\n";
    return cave::load_cave(cave, "");
  }();
  return low;
}

/// Where it flies.
struct Scene {
  const cave::Cave& cave = small_cave();
  bool in_team = false;
  bool meets_another = false;  // that goes first, and comes nearer from where the vehicle flies to
  double takeoff_height_m = CoreOptions{}.mission.takeoff_height_m;
};

/// What goes wrong, once it is due.
struct Fault {
  std::string name = {};      // of the step or job that throws; "" for none
  bool for_good = true;       // or once
  bool when_fast = true;      // at 1.5 m/s; or the first time that it runs
  bool starved = false;       // no step and no job of the core is given memory any more
  bool stopped = false;       // by the operator
  std::string left_out = {};  // a job whose work is never done: how plans fail
};

/// While it lives, nothing on this thread is given memory.
class Starved {
 public:
  explicit Starved(bool really) : before_(out_of_memory) { out_of_memory = before_ || really; }
  ~Starved() { out_of_memory = before_; }
  Starved(const Starved&) = delete;
  Starved& operator=(const Starved&) = delete;

 private:
  bool before_;
};

class FaultyExecutive final : public Executive {
 public:
  FaultyExecutive(Fault fault, std::function<bool()> due)
      : Executive(1), fault_(std::move(fault)), due_(std::move(due)) {}

  void every(std::string name, TimeNs first, TimeNs period, std::function<void()> step) override {
    Executive::every(name, first, period, [this, name, step = std::move(step)] {
      const Starved starved(starves(name));
      inject_fault(name);
      step();
    });
  }
  void job(std::string name, Lane lane, TimeNs budget, std::function<void()> work,
           std::function<void()> publish) override {
    Executive::job(
        name, lane, budget,
        [this, name, work = std::move(work)] {
          const Starved starved(starves(name));
          inject_fault(name);
          if (name != fault_.left_out) work();
        },
        [this, name, publish = std::move(publish)] {
          const Starved starved(starves(name));
          publish();
        });
  }
  bool starves(const std::string& name) const {
    const bool simulated =
        name == "vehicle" || name == "lidar" || name == "depth camera" || name == "rgb camera";
    return fault_.starved && !simulated && due_();
  }
  std::optional<TimeNs> struck_at() const { return struck_at_; }

 private:
  void inject_fault(const std::string& name) {
    if (name != fault_.name || (struck_at_ && !fault_.for_good) || (!struck_at_ && !due_())) return;
    if (!struck_at_) struck_at_ = now();
    throw std::runtime_error(kText);
  }

  Fault fault_;
  std::function<bool()> due_;
  std::optional<TimeNs> struck_at_;
};

/// The vehicle's messages reach a core without memory.
class StarvedSink final : public VehicleSink {
 public:
  StarvedSink(VehicleSink& sink, const FaultyExecutive& executive) : sink_(sink), executive_(executive) {}
  void on_lidar(std::shared_ptr<const LidarScan> s) override {
    call([&] { sink_.on_lidar(std::move(s)); });
  }
  void on_depth(std::shared_ptr<const DepthImage> s) override {
    call([&] { sink_.on_depth(std::move(s)); });
  }
  void on_rgb(const std::shared_ptr<const RgbFrame>& s) override {
    call([&] { sink_.on_rgb(s); });
  }
  void on_objects(const ObjectDetections& s) override {
    call([&] { sink_.on_objects(s); });
  }
  void on_imu(const ImuSample& s) override {
    call([&] { sink_.on_imu(s); });
  }
  void on_magnetometer(const MagnetometerSample& s) override {
    call([&] { sink_.on_magnetometer(s); });
  }
  void on_barometer(const BarometerSample& s) override {
    call([&] { sink_.on_barometer(s); });
  }
  void on_pose(const PoseSample& s) override {
    call([&] { sink_.on_pose(s); });
  }
  void on_battery(const BatteryStatus& s) override {
    call([&] { sink_.on_battery(s); });
  }
  void on_ground(TimeNs t) override {
    call([&] { sink_.on_ground(t); });
  }
  void on_lift_off(TimeNs t) override {
    call([&] { sink_.on_lift_off(t); });
  }
  void on_lost(TimeNs t, MissionOutcome outcome, const std::string& why) override {
    sink_.on_lost(t, outcome, why);
  }

 private:
  void call(const auto& f) {
    const Starved starved(executive_.starves("sink"));
    f();
  }
  VehicleSink& sink_;
  const FaultyExecutive& executive_;
};

/// A simulated vehicle behind such a sink.
class StarvedVehicle final : public Vehicle {
 public:
  StarvedVehicle(sim::SimulatedVehicle& vehicle, const FaultyExecutive& starving)
      : vehicle_(vehicle), starving_(starving) {}
  VehicleDescription description() const override { return vehicle_.description(); }
  void start(Executive& executive, VehicleSink& sink) override {
    vehicle_.start(executive, sink_.emplace(sink, starving_));
  }
  void command(const Command& c) override { vehicle_.command(c); }
  void finish() override { vehicle_.finish(); }

 private:
  sim::SimulatedVehicle& vehicle_;
  const FaultyExecutive& starving_;
  std::optional<StarvedSink> sink_;
};

struct Ended {
  MissionResult result;
  double struck_at_s = -1, ended_at_s = 0, fast_mps = 0;
  std::string events;
};

/// Another vehicle of the team, heard over the radio alone: from the 8th second on it comes towards `vehicle`
/// from ahead at half a metre a second.
class Oncoming {
 public:
  Oncoming(Executive& executive, const sim::SimulatedVehicle& vehicle, TeamNode& told, TeamNode says)
      : vehicle_(vehicle), told_(told), says_(std::move(says)) {
    executive.every("oncoming", 0, kSecond / 10, [this, &executive] { transmit(executive.now()); });
  }

 private:
  void transmit(TimeNs now) {
    constexpr double kSpeed_mps = 0.5, kFrom_m = 6;
    if (now < 8 * kSecond) return;
    if (!ahead_) ahead_ = vehicle_.velocity_mps().normalized();
    TeamState state;
    state.phase = TeamPhase::explore, state.stamp = now;
    state.position = vehicle_.position() + std::max(1.0, kFrom_m - kSpeed_mps * (seconds(now) - 8)) * *ahead_;
    state.velocity_mps = -kSpeed_mps * *ahead_;
    says_.set_state(state);
    for (const Bytes& frame : says_.transmit(now)) told_.receive(frame, now);
  }

  const sim::SimulatedVehicle& vehicle_;
  TeamNode& told_;
  TeamNode says_;
  std::optional<Vec3> ahead_;
};

/// A flight that the fault strikes when it is as fast, `seed` seconds later for each seed.
Ended fly(const Fault& fault, int seed, const Scene& scene = {}) {
  const auto folder =
      fresh_folder("emergency_" + (fault.name.empty() ? "x" : fault.name) + std::to_string(seed));
  sim::SimulatorOptions simulator;
  simulator.wind.gust_mps = 1;
  simulator.rgb.fitted = simulator.rgb.pictures =
      fault.name == "rgb camera" || fault.name == "imaged surface" || fault.name == "picture file";
  VehicleSetup setup;
  setup.run_dir = folder.string();
  setup.seed = static_cast<std::uint64_t>(seed);
  CoreOptions options;
  options.mission.max_flight_time_s = 200;
  options.mission.takeoff_height_m = scene.takeoff_height_m;
  setup.climb_m = options.mission.takeoff_height_m;

  Recorder recorder(folder);
  sim::SimulatedVehicle simulated(simulator, setup, scene.cave);
  Ended out;
  FaultyExecutive* clock = nullptr;
  const auto due = [&] {
    if (!fault.when_fast) return true;
    const double speed_mps = simulated.velocity_mps().norm();
    if (out.fast_mps > 0) return true;
    if (speed_mps < kFast_mps || clock->now() < (6 + seed) * kSecond) return false;
    out.fast_mps = speed_mps;
    out.struck_at_s = seconds(clock->now());
    return true;
  };
  FaultyExecutive executive(fault, due);
  clock = &executive;
  StarvedVehicle vehicle(simulated, executive);
  Tourist policy(fault.when_fast ? 100 * kSecond : 20 * kSecond);
  const VehicleDescription described = vehicle.description();
  const Vec3& base = described.T_world_start.position;
  const auto teammate = [&](RobotId id) {
    return TeamNode(id, options.team, options.homing, base, setup.seed, key_of_seed(setup.seed));
  };
  TeamNode node = teammate(2);
  RelayHoming homing(
      2, {options.team, options.homing, options.planning, options.motion, described.radius_m, base});
  Teamwork team(node, homing, options.team, 0);
  MissionControl control(options, vehicle, executive, policy, recorder, scene.in_team ? &team : nullptr);
  std::optional<Oncoming> other;
  if (scene.meets_another) other.emplace(executive, simulated, node, teammate(1));
  out.result = control.run([&](const MissionStatus&) { return !(fault.stopped && due()); });
  if (executive.struck_at()) out.struck_at_s = seconds(*executive.struck_at());
  out.ended_at_s = seconds(executive.now());
  out.events = bytes_of(folder / "events.jsonl");
  return out;
}

void expect_landed_at_once(const Ended& flight, const std::string& reason) {
  EXPECT_EQ(flight.result.outcome, MissionOutcome::aborted) << flight.result.reason;
  EXPECT_TRUE(flight.result.stands) << flight.result.reason;
  EXPECT_EQ(flight.result.reason.find(reason + ": on the ground "), 0u) << flight.result.reason;
  EXPECT_EQ(flight.result.record_problem, "");
  ASSERT_GT(flight.struck_at_s, 0) << "it never happened";
  EXPECT_LT(flight.ended_at_s - flight.struck_at_s, 20);
  EXPECT_NE(flight.events.find("\"outcome\":\"aborted\""), std::string::npos);
}

class FailureInFlight : public ::testing::TestWithParam<const char*> {};

TEST_P(FailureInFlight, OfAStepOrJobBrakesAndLands) {
  for (int seed = 1; seed <= seeds(); ++seed) {
    SCOPED_TRACE(seed);
    const std::string name = GetParam();
    const bool step = name == "control" || name == "vehicle";  // without them nothing flies
    const Ended flight = fly({.name = name, .for_good = !step}, seed, {.in_team = name == "team"});
    EXPECT_GE(flight.fast_mps, kFast_mps);
    expect_landed_at_once(flight, kText);
  }
}
INSTANTIATE_TEST_SUITE_P(AtSpeed, FailureInFlight,
                         ::testing::Values("control", "supervise", "watch", "vehicle", "lidar",
                                           "depth camera", "rgb camera", "localization", "mapping",
                                           "imaged surface", "picture file", "decision", "home estimate",
                                           "team"));

class FailureOnTheWayHome : public ::testing::TestWithParam<const char*> {};

TEST_P(FailureOnTheWayHome, OfAJobBrakesAndLands) {
  const std::string name = GetParam();
  Fault fault{.name = name, .when_fast = false};
  if (name == "way back") fault.left_out = "home plan";
  const bool in_team = name == "landing place" || name == "give up";
  expect_landed_at_once(fly(fault, 1, {.in_team = in_team}), kText);
}
INSTANTIATE_TEST_SUITE_P(Jobs, FailureOnTheWayHome,
                         ::testing::Values("home", "farewell", "home plan", "way back", "landing place",
                                           "give up"));

TEST(FailureWhenMeetingAnother, OfMakingRoomLands) {
  for (int seed = 1; seed <= seeds(); ++seed) {
    SCOPED_TRACE(seed);
    const Ended flight =
        fly({.name = "make room", .when_fast = false}, seed, {.in_team = true, .meets_another = true});
    expect_landed_at_once(flight, kText);
    EXPECT_NE(flight.events.find("give way"), std::string::npos);
  }
}

TEST(FailureBelowAFallenRoof, OfChoosingTheHoverLands) {
  const Ended flight =
      fly({.name = "hover", .when_fast = false}, 1, {.cave = falling_roof(), .takeoff_height_m = 2.4});
  expect_landed_at_once(flight, kText);
}

TEST(FailureOnTheGround, OfAJobEndsTheMissionThere) {
  const Ended flight = fly({.name = "launch site", .when_fast = false}, 1);
  EXPECT_EQ(flight.result.outcome, MissionOutcome::aborted);
  EXPECT_TRUE(flight.result.stands);
  EXPECT_LT(flight.ended_at_s, 0.2);
}

TEST(OutOfMemory, TheVehicleBrakesAndLands) {
  for (int seed = 1; seed <= seeds(); ++seed) {
    SCOPED_TRACE(seed);
    const Ended flight = fly({.starved = true}, seed);
    EXPECT_GE(flight.fast_mps, kFast_mps);
    EXPECT_EQ(flight.result.outcome, MissionOutcome::aborted);
    EXPECT_TRUE(flight.result.stands) << flight.result.reason;
    EXPECT_LT(flight.ended_at_s - flight.struck_at_s, 20);
  }
}

TEST(Operator, WhoEndsTheFlightHasTheVehicleBrakeAndLand) {
  for (int seed = 1; seed <= seeds(); ++seed) {
    SCOPED_TRACE(seed);
    const Ended flight = fly({.stopped = true}, seed);
    EXPECT_GE(flight.fast_mps, kFast_mps);
    expect_landed_at_once(flight, "stopped by the operator");
  }
}

}  // namespace
}  // namespace karst::core
