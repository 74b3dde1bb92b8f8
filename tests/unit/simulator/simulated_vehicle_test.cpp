#include "plugins/simulator/simulated_vehicle.h"

#include <dlfcn.h>

#include <boost/property_tree/ptree.hpp>
#include <sstream>

#include "meshes.h"

namespace karst::test {
namespace {

using namespace core;
using sim::SimulatedVehicle;
using sim::SimulatorOptions;

/// Writes down every message as text with all digits, and flies a little hop on the pose sensor.
class Listener final : public VehicleSink {
 public:
  void on_lidar(std::shared_ptr<const LidarScan> s) override {
    log << "lidar " << s->stamp << " at " << executive->now();
    for (const float r : s->range_m) log << ' ' << r;
    log << '\n';
    ++lidar;
    last_scan = s;
  }
  void on_depth(std::shared_ptr<const DepthImage> d) override {
    log << "depth " << d->model->name << ' ' << d->stamp << ' ' << d->range_m[100] << '\n';
    ++depth;
  }
  void on_imu(const ImuSample& s) override {
    log << "imu " << s.stamp << ' ' << s.specific_force_mps2.transpose() << ' '
        << s.body_rate_radps.transpose() << '\n';
    if (imu++ < 200) mean_force += s.specific_force_mps2 / 200;
  }
  void on_magnetometer(const MagnetometerSample& s) override {
    log << "mag " << s.field_ut.transpose() << '\n', ++magnetometer;
  }
  void on_pose(const PoseSample& s) override {
    log << "pose " << s.stamp << ' ' << s.T_world_body.position.transpose() << '\n';
    pose_delay = executive->now() - s.stamp;
    pose = s.T_world_body;
    ++poses;
  }
  void on_battery(const BatteryStatus& s) override {
    log << "battery " << s.energy_left_wh << '\n', ++battery;
  }
  void on_ground(TimeNs t) override {
    log << "ground " << t << '\n';
    grounds += 'G';
  }
  void on_lift_off(TimeNs t) override {
    log << "lift-off " << t << '\n';
    grounds += 'A';
  }
  void on_lost(TimeNs t, MissionOutcome outcome, const std::string& why) override {
    log << "lost " << t << ' ' << name_of(outcome) << ' ' << why << '\n';
    lost = outcome;
    reason = why;
  }

  Listener() { log.precision(17); }
  const Executive* executive = nullptr;
  std::ostringstream log;
  int lidar = 0, depth = 0, imu = 0, magnetometer = 0, poses = 0, battery = 0;
  TimeNs pose_delay = 0;
  Vec3 mean_force = Vec3::Zero();
  Pose pose;
  std::shared_ptr<const LidarScan> last_scan;
  std::string grounds, reason;
  std::optional<MissionOutcome> lost;
};

class Simulation : public testing::Test {
 protected:
  Simulation() {
    cave::write_mesh(folder + "/hall.ply", box_mesh({-8, -8, 0}, {8, 8, 6}));
    options.lidar.columns = 128;
    options.pose.fitted = sim::PoseSensorFitted::always;
    setup.cave = folder + "/hall.ply";
    setup.start = "1 2 1.5 90";
    setup.run_dir = folder;
  }
  /// Flies for `duration_s` with this thrust schedule; returns all messages.
  std::string fly(double duration_s, const std::function<double(double t, double z)>& thrust_over_weight,
                  int threads = 1) {
    SimulatedVehicle vehicle(options, setup);
    Executive executive(threads);
    listener = std::make_unique<Listener>();
    listener->executive = &executive;
    listener->pose = vehicle.description().T_world_start;
    vehicle.start(executive, *listener);
    executive.every("control", 10 * kMillisecond, 10 * kMillisecond, [&] {
      const double lift = thrust_over_weight(seconds(executive.now()), listener->pose.position.z());
      vehicle.command({Vec3::Zero(), lift * vehicle.description().mass_kg * 9.81, lift > 0});
    });
    executive.run_until(from_seconds(duration_s), [&] { return listener->lost.has_value(); });
    executive.drain();
    vehicle.finish();
    return listener->log.str();
  }
  static double hop(double t, double) { return t < 0.5 ? 0 : t < 1.5 ? 1.1 : 0.96; }

  std::string folder = scratch_folder();
  SimulatorOptions options;
  VehicleSetup setup;
  std::unique_ptr<Listener> listener;
};

TEST_F(Simulation, AFirstHoverUnderTheCeilingIsRefusedBeforeTheFlight) {
  setup.climb_m = 5.2;  // the hull of 0.3 m radius stands on the floor of a hall 6 m high
  EXPECT_EQ(error_of([&] { SimulatedVehicle(options, setup); }), "");
  setup.climb_m = 5.4;
  EXPECT_NE(error_of([&] { SimulatedVehicle(options, setup); }).find("can rise by"), std::string::npos);
}

TEST_F(Simulation, MessagesComeAtTheirRates) {
  fly(2.0, [](double, double) { return 0; });
  EXPECT_EQ(listener->imu, 400);
  EXPECT_EQ(listener->magnetometer, 100);
  EXPECT_EQ(listener->poses, 97) << "every 20 ms, and what was measured after 1.95 s is still to come";
  EXPECT_EQ(listener->pose_delay, 50 * kMillisecond);
  EXPECT_EQ(listener->lidar, 19) << "the last sweep is still being cast";
  EXPECT_EQ(listener->depth, 2 * 10) << "two cameras, five images a second";
  EXPECT_EQ(listener->battery, 5);
  EXPECT_EQ(listener->grounds, "G");
}

TEST_F(Simulation, WithoutThePoseSensorThereIsNotOneMessageOfItAndAllElseIsTheSame) {
  const std::string with = fly(2.0, [](double, double) { return 0; });
  options.pose.fitted = sim::PoseSensorFitted::never;
  const std::string without = fly(2.0, [](double, double) { return 0; });
  EXPECT_EQ(listener->poses, 0);
  const auto but_poses = [](const std::string& log) {
    std::istringstream in(log);
    std::string kept;
    for (std::string line; std::getline(in, line);)
      if (!line.starts_with("pose ")) kept += line + '\n';
    return kept;
  };
  EXPECT_EQ(without.find("pose "), std::string::npos);
  EXPECT_TRUE(but_poses(with) == without);
}

TEST_F(Simulation, FaultsOfTheCaveStrikeAndAreWrittenDown) {
  write_bytes(folder + "/cave.info", R"(mesh hall.ply
start "1 2 1.5 90"
fault { sensor lidar kind lost after 0.45 for 1 }
fault { sensor lidar kind nan after 1.55 }
fault { sensor lidar kind three_points after 1.65 }
fault { sensor lidar kind stamp_back after 1.75 }
fault { sensor imu after 0.2 for 0.5 }
fault { sensor magnetometer after 0.2 for 0.5 }
fault { sensor camera after 0.5 for 1 }
fault { sensor pose after 0.5 for 1 }
)");
  setup.cave = folder + "/cave.info";
  const std::string log = fly(2.0, [](double, double) { return 0; });
  EXPECT_EQ(listener->lidar, 19 - 10);
  EXPECT_EQ(listener->imu, 400 - 100);
  EXPECT_EQ(listener->magnetometer, 100 - 25);
  EXPECT_EQ(listener->depth, 20 - 10);
  EXPECT_EQ(listener->poses, 97 - 50);
  std::vector<double> stamps;
  std::vector<int> finite;
  std::istringstream in(log);
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("lidar ")) {
      std::istringstream words(line);
      std::string word;
      TimeNs stamp = 0;
      words >> word >> stamp >> word >> word;
      stamps.push_back(seconds(stamp));
      int n = 0;
      while (words >> word) n += word != "nan" && word != "inf";
      finite.push_back(n);
    }
  const auto count_at = [&](double t) {
    return finite.at(static_cast<std::size_t>(std::find(stamps.begin(), stamps.end(), t) - stamps.begin()));
  };
  EXPECT_EQ(count_at(0.1), 32 * 128);
  EXPECT_EQ(count_at(1.6), 32 * 128 / 2);
  EXPECT_EQ(count_at(1.7), 3);
  EXPECT_EQ(count_at(1.55), 32 * 128) << "1.8 s, stamped 250 ms early";
  const std::string events = read_bytes(folder + "/truth_events.jsonl");
  for (const char* what : {"lidar lost for 1.000 s", "lidar nan", "lidar three_points", "lidar stamp_back",
                           "imu lost for 0.500 s", "magnetometer lost", "camera lost", "pose lost"})
    EXPECT_NE(events.find(what), std::string::npos) << what;
  EXPECT_NE(events.find("\"time_s\": 0.500, \"event\": \"fault\""), std::string::npos) << events;
}

TEST_F(Simulation, DustStirredUpOverTheFloorReachesTheLidarAndRepeatsItself) {
  const std::string clear = fly(3, hop);
  const std::vector<float> rock = listener->last_scan->range_m;
  options.air.stirred_1pm = 2;
  const std::string one = fly(3, hop, 1);
  int nearer = 0, lost = 0;
  for (std::size_t i = 0; i < rock.size(); ++i) {
    nearer += listener->last_scan->range_m[i] < rock[i] - 0.1f;
    lost += std::isnan(listener->last_scan->range_m[i]);
  }
  EXPECT_GT(nearer, 40) << "of 4096";
  EXPECT_LT(nearer + lost, 3000) << "it lies on the floor";
  EXPECT_TRUE(one == fly(3, hop, 4)) << "with any number of threads";
  const auto imu_of = [](const std::string& log) { return log.substr(log.rfind("imu "), 60); };
  EXPECT_EQ(imu_of(one), imu_of(clear)) << "dust changes no other sensor's noise";
}

TEST_F(Simulation, AtRestTheImuReadsGravity) {
  options.wind.gust_mps = 3;
  fly(1.0, [](double, double) { return 0; });
  // Bias 0.03 and the mean of 200 samples of 0.05 m/s^2.
  EXPECT_LT((listener->mean_force - Vec3(0, 0, 9.81)).norm(), 0.15);
}

TEST_F(Simulation, DescriptionSaysWhatWasMounted) {
  const VehicleDescription lidar_uav = SimulatedVehicle(options, setup).description();
  EXPECT_TRUE(lidar_uav.lidar);
  ASSERT_EQ(lidar_uav.cameras.size(), 2u);
  EXPECT_LT((lidar_uav.T_world_start.position - Vec3(1, 2, 0.3)).norm(), 1e-3);
  EXPECT_NEAR(heading_of(lidar_uav.T_world_start.orientation), std::numbers::pi / 2, 1e-9);
  EXPECT_NEAR(lidar_uav.max_thrust_n, 2.2 * 2 * 9.81, 1e-9);
  options.vehicle = sim::VehiclePreset::lidar_only_uav;
  EXPECT_TRUE(SimulatedVehicle(options, setup).description().lidar);
  EXPECT_TRUE(SimulatedVehicle(options, setup).description().cameras.empty());
  options.vehicle = sim::VehiclePreset::camera_uav;
  const VehicleDescription camera_uav = SimulatedVehicle(options, setup).description();
  EXPECT_FALSE(camera_uav.lidar);
  ASSERT_EQ(camera_uav.cameras.size(), 1u);
  EXPECT_EQ(camera_uav.cameras[0]->name, "forward");
}

TEST_F(Simulation, TwoRunsAreTheSameBytesAlsoWithOtherThreads) {
  const std::string a = fly(3, hop, 1);
  const std::string tum = read_bytes(folder + "/ground_truth.tum"), csv = read_bytes(folder + "/truth.csv"),
                    events = read_bytes(folder + "/truth_events.jsonl");
  EXPECT_EQ(listener->grounds.substr(0, 2), "GA");
  const std::string b = fly(3, hop, 4);
  EXPECT_TRUE(a == b);
  EXPECT_TRUE(tum == read_bytes(folder + "/ground_truth.tum"));
  EXPECT_TRUE(csv == read_bytes(folder + "/truth.csv"));
  EXPECT_TRUE(events == read_bytes(folder + "/truth_events.jsonl"));
  EXPECT_GT(tum.size(), 300u * 40u);
  setup.seed = 2;
  EXPECT_FALSE(a == fly(3, hop, 1)) << "another seed is another flight";
}

TEST_F(Simulation, ASweepEndsWhereTheVehicleIsWhenItEnds) {
  options.lidar.noise_m = 0;
  options.wind.gust_mps = 0;
  fly(1.6, hop);
  // Straight below the sensor nothing is seen; the lowest beam ahead meets the floor at 45 degrees.
  std::istringstream tum(read_bytes(folder + "/ground_truth.tum"));
  double t = 0, x = 0, y = 0, z = 0, rest = 0, z_at_end = 0;
  while (tum >> t >> x >> y >> z >> rest >> rest >> rest >> rest)
    if (std::abs(t - seconds(listener->last_scan->stamp)) < 1e-6) z_at_end = z;
  const auto& scan = *listener->last_scan;
  const float range = scan.range_m.back();  // the last channel's last column
  EXPECT_NEAR(range * std::sin(-scan.model->elevation_rad.back()),
              z_at_end + scan.model->T_body_lidar.position.z(), 2e-3);
  EXPECT_GT(z_at_end, 0.4) << "in flight";
}

TEST_F(Simulation, ACrashEndsTheVehicleWithItsReason) {
  fly(20, [](double t, double) { return t < 2 ? 1.3 : 0.0; });
  EXPECT_EQ(listener->lost, MissionOutcome::contact);
  EXPECT_NE(listener->reason.find("touched rock at ("), std::string::npos) << listener->reason;
  EXPECT_NE(listener->reason.find("m/s"), std::string::npos);
  const std::string events = read_bytes(folder + "/truth_events.jsonl");
  EXPECT_NE(events.find("\"contact\""), std::string::npos);
  EXPECT_NE(events.find("\"take-off\""), std::string::npos);
}

TEST_F(Simulation, AnEmptyBatteryEndsTheVehicle) {
  options.battery.minutes = 0.1;
  options.wind.gust_mps = 0;
  fly(70, [](double, double) { return 1.0; });  // motors turning, not enough to lift
  EXPECT_EQ(listener->lost, MissionOutcome::battery);
}

TEST_F(Simulation, GroundTruthIsWrittenInTheAnnouncedShape) {
  fly(1.0, [](double, double) { return 0; });
  std::istringstream tum(read_bytes(folder + "/ground_truth.tum")), csv(read_bytes(folder + "/truth.csv"));
  std::string line;
  int lines = 0;
  for (; std::getline(tum, line); ++lines) {
    std::istringstream words(line);
    int numbers = 0;
    for (double v; words >> v;) ++numbers;
    ASSERT_EQ(numbers, 8) << line;
  }
  EXPECT_EQ(lines, 101);
  std::getline(csv, line);
  EXPECT_EQ(line.find("time_s,clearance_m,speed_mps,battery,"), 0u);
  lines = 0;
  for (; std::getline(csv, line); ++lines) EXPECT_EQ(std::count(line.begin(), line.end(), ','), 7);
  EXPECT_EQ(lines, 21);
}

TEST_F(Simulation, BadSetupsAreErrorsWithReasons) {
  const auto error = [&] { return error_of([&] { SimulatedVehicle(options, setup); }); };
  setup.start = "0 0 20";
  EXPECT_NE(error().find("outside of the cave"), std::string::npos);
  setup.start = "";
  EXPECT_NE(error().find("start"), std::string::npos);
  setup.start = "1 2 1.5";
  setup.run_dir = "/nowhere/at/all";
  EXPECT_NE(error().find("/nowhere/at/all"), std::string::npos);
  setup.run_dir = "";
  EXPECT_EQ(error(), "") << "without a run directory nothing is written";
}

TEST_F(Simulation, OptionsReadBackAsTheyAreWrittenOut) {
  OptionTable table;
  describe(table, options);
  for (const auto& row : table.rows()) {
    EXPECT_FALSE(row.help.empty()) << row.key;
    table.set("test", row.key, value_text(row));  // throws if the default is out of its own range
  }
  table.set("mission.info", "gust", "3 m/s");
  table.set("mission.info", "battery_minutes", "300 s");
  table.set("mission.info", "lidar.unit", "os1_64");
  EXPECT_EQ(options.wind.gust_mps, 3);
  EXPECT_EQ(options.battery.minutes, 5);
  EXPECT_EQ(options.lidar.unit, "os1_64");
  EXPECT_NE(error_of([&] { table.set("mission.info", "lidar.unit", "os1_46"); }).find("os1_64"),
            std::string::npos);
}

TEST_F(Simulation, ThePluginIsLoadedByItsOneSymbol) {
  void* library =
      dlopen(KARST_BINARY_DIR "/lib/karst/vehicles/libkarst_vehicle_simulator.so", RTLD_NOW | RTLD_LOCAL);
  ASSERT_NE(library, nullptr) << dlerror();
  const auto entry = reinterpret_cast<karst_vehicle_plugin_fn>(dlsym(library, "karst_vehicle_plugin"));
  ASSERT_NE(entry, nullptr);
  OptionTable table;
  entry()->describe_options(table);
  table.set("mission.info", "vehicle", "camera_uav");
  EXPECT_EQ(entry()->create(setup)->description().name, "camera_uav");
  setup.cave = "/no/such/cave.info";
  EXPECT_NE(error_of([&] { entry()->create(setup); }).find("/no/such/cave.info"), std::string::npos)
      << "errors cross the plugin's border as what they are";
}

/// A vehicle that rises, begins to roll at `roll_from_s`, and gets no command after 2.5 s.
class WithoutCommands : public Simulation {
 protected:
  WithoutCommands() {
    listener = std::make_unique<Listener>();
    listener->executive = &executive;
    vehicle.start(executive, *listener);
  }
  void roll(double from_s, double rate_radps) {
    executive.every("control", 10 * kMillisecond, 10 * kMillisecond, [this, from_s, rate_radps] {
      const double t = seconds(executive.now());
      const double weight_n = vehicle.description().mass_kg * 9.81;
      Command c;
      c.rates = {Vec3(t > from_s ? rate_radps : 0, 0, 0), (t < 1 ? 1.15 : 1.01) * weight_n, true};
      c.state_is_known = true;
      c.state.velocity_mps = vehicle.velocity_mps();
      if (t < 2.5) vehicle.command(c);
    });
  }

  SimulatedVehicle vehicle{options, setup};
  Executive executive{1};
};

TEST_F(WithoutCommands, TheAutopilotLevelsTheVehicleAndComesDown) {
  roll(2.3, 0.1);
  executive.run_until(from_seconds(2.5), [] { return false; });
  ASSERT_EQ(listener->grounds, "GA");
  const double height_m = vehicle.position().z();
  executive.run_until(from_seconds(5), [] { return false; });
  EXPECT_NEAR(vehicle.velocity_mps().z(), -0.5, 0.05);
  executive.run_until(from_seconds(15), [&] { return listener->lost.has_value(); });
  EXPECT_EQ(listener->grounds, "GAG") << "it stands " << listener->reason;
  EXPECT_GT(height_m, 0.5);
  EXPECT_FALSE(vehicle.airborne());
  executive.run_until(from_seconds(20), [] { return false; });
  EXPECT_EQ(listener->grounds, "GAG") << "and its motors are off";
  vehicle.finish();
}

// The rates of the last command were held for half a second: at 1 rad/s that tipped it over by 30 degrees.
TEST_F(WithoutCommands, RatesOfTheLastCommandAreNotHeld) {
  roll(2.45, 1);
  double fastest_mps = 0;
  executive.every("watch", 10 * kMillisecond, 10 * kMillisecond,
                  [&] { fastest_mps = std::max(fastest_mps, vehicle.velocity_mps().head<2>().norm()); });
  executive.run_until(from_seconds(3.9), [] { return false; });
  EXPECT_LT(fastest_mps, 0.5);
  EXPECT_NEAR(vehicle.velocity_mps().norm(), 0, 0.1) << "it hovers first";
  vehicle.finish();
}

}  // namespace
}  // namespace karst::test
