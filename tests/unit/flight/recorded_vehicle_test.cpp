// A recorded vehicle is the vehicle, and what its sensors said is in the folder.
#include "sdk/flight/recorded_vehicle.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core_stack/common/error.h"
#include "plugins/replay/recording.h"
#include "tests/unit/replay/folder.h"

namespace karst::flight {
namespace {

namespace fs = std::filesystem;
using core::kMillisecond;
using core::TimeNs;

/// Has a scan each tenth of a second, IMU samples each hundredth, and a compass and a barometer.
class TalkingVehicle final : public core::Vehicle {
 public:
  TalkingVehicle() {
    auto model = std::make_shared<core::LidarModel>();
    model->columns = 4;
    model->elevation_rad = {0.1f, -0.1f};
    lidar = model;
  }
  core::VehicleDescription description() const override {
    core::VehicleDescription d;
    d.name = "talking";
    d.lidar = lidar;
    return d;
  }
  void start(core::Executive& executive, core::VehicleSink& sink) override {
    executive.every("scan", 100 * kMillisecond, 100 * kMillisecond, [&] {
      auto scan = std::make_shared<core::LidarScan>();
      scan->stamp = executive.now() + stamps_off;
      scan->model = lidar;
      scan->range_m.assign(8, 2.0f + static_cast<float>(scans++));
      scan->intensity.assign(8, 0.5f);
      sink.on_lidar(scan);
    });
    executive.every("imu", 10 * kMillisecond, 10 * kMillisecond, [&] {
      sink.on_imu({executive.now(), {0.1, 0.2, 9.81}, {0.01, 0.02, 0.03}});
      sink.on_magnetometer({executive.now(), {20, 1, -40}});
      sink.on_barometer({executive.now(), 1.25});
    });
  }
  void command(const core::Command&) override { ++commands; }
  void finish() override { finished = true; }

  std::shared_ptr<const core::LidarModel> lidar;
  TimeNs stamps_off = 0;
  int scans = 0, commands = 0;
  bool finished = false;
};

/// Notes what comes, and when.
class Listener final : public core::VehicleSink {
 public:
  explicit Listener(core::Executive& executive) : executive_(executive) {}
  void on_lidar(std::shared_ptr<const core::LidarScan> s) override { note("scan", s->stamp); }
  void on_depth(std::shared_ptr<const core::DepthImage>) override {}
  void on_imu(const core::ImuSample& s) override { note("imu", s.stamp); }
  void on_magnetometer(const core::MagnetometerSample& s) override { note("compass", s.stamp); }
  void on_barometer(const core::BarometerSample& s) override { note("barometer", s.stamp); }
  void on_pose(const core::PoseSample&) override {}
  void on_battery(const core::BatteryStatus&) override {}
  void on_ground(TimeNs) override {}
  void on_lift_off(TimeNs) override {}
  void on_lost(TimeNs, core::MissionOutcome, const std::string&) override {}
  std::string heard;

 private:
  void note(const char* what, TimeNs stamp) {
    heard +=
        std::string(what) + " " + std::to_string(stamp) + " at " + std::to_string(executive_.now()) + "\n";
  }
  core::Executive& executive_;
};

std::string heard_of(core::Vehicle& vehicle) {
  core::Executive executive(1);
  Listener listener(executive);
  vehicle.start(executive, listener);
  executive.run_until(2 * core::kSecond, [] { return false; });
  executive.drain();
  vehicle.finish();
  return listener.heard;
}

std::size_t scans_in(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::count_if(fs::directory_iterator(folder), {},
                    [](const fs::directory_entry& e) { return e.path().extension() == ".pcd"; }));
}

TEST(RecordedVehicle, PassesEverythingOnAsTheVehicleSaysIt) {
  const test::Folder folder;
  TalkingVehicle plain, inside;
  core::Recorder recorder(folder.path() / "run");
  RecordedVehicle recorded(inside, recorder);
  EXPECT_EQ(recorded.description().name, "talking");
  recorded.command({});
  EXPECT_EQ(inside.commands, 1);
  EXPECT_EQ(heard_of(recorded), heard_of(plain));
  EXPECT_TRUE(inside.finished);
}

TEST(RecordedVehicle, RecordsEachScanAndSampleForReplay) {
  for (const auto durability : {core::Durability::survives_a_crash, core::Durability::survives_a_power_cut}) {
    const test::Folder folder;
    TalkingVehicle vehicle;
    core::Recorder recorder(folder.path() / "run", durability);
    RecordedVehicle recorded(vehicle, recorder);
    heard_of(recorded);
    EXPECT_TRUE(recorder.close());
    const replay::Recording recording = replay::open_recording(folder.path() / "run" / "scans", "");
    ASSERT_EQ(recording.files.size(), 20u);
    for (std::size_t i = 0; i < recording.files.size(); ++i) {
      EXPECT_EQ(recording.files[i].stamp, static_cast<TimeNs>(i) * 100 * kMillisecond);
      const core::Sweep sweep = replay::read_sweep(recording, i);
      ASSERT_EQ(sweep.points.size(), 8u);
      EXPECT_NEAR(sweep.points[0].position.norm(), 2.0f + static_cast<float>(i), 1e-5);
    }
    auto imu = *replay::open_imu(recording);
    std::size_t samples = 0;
    while (const auto sample = imu.next()) {
      EXPECT_EQ(sample->stamp, static_cast<TimeNs>(++samples) * 10 * kMillisecond);
      EXPECT_EQ(sample->specific_force_mps2, core::Vec3(0.1, 0.2, 9.81));
      EXPECT_EQ(sample->body_rate_radps, core::Vec3(0.01, 0.02, 0.03));
    }
    EXPECT_EQ(samples, 200u);
  }
}

TEST(RecordedVehicle, ScansThatGoBackInTimeAreLeftOut) {
  const test::Folder folder;
  TalkingVehicle vehicle;
  core::Recorder recorder(folder.path() / "run");
  RecordedVehicle recorded(vehicle, recorder);
  core::Executive executive(1);
  Listener listener(executive);
  recorded.start(executive, listener);
  executive.at(1050 * kMillisecond, [&] { vehicle.stamps_off = -500 * kMillisecond; });
  executive.run_until(2 * core::kSecond, [] { return false; });
  recorded.finish();
  EXPECT_EQ(scans_in(folder.path() / "run" / "scans"), 15u);
  EXPECT_NO_THROW(replay::open_recording(folder.path() / "run" / "scans", ""));
}

TEST(RecordedVehicle, AFolderThatCannotBeMadeIsAnErrorBeforeTheFlight) {
  const test::Folder folder;
  TalkingVehicle vehicle;
  core::Recorder recorder(folder.path() / "run");
  folder.write("run/scans", "a file");
  EXPECT_THROW(RecordedVehicle(vehicle, recorder), core::InputError);
}

TEST(RecordedVehicle, AScanThatCannotBeWrittenEndsNothingAndIsReportedAtTheEnd) {
  const test::Folder folder;
  TalkingVehicle vehicle;
  core::Recorder recorder(folder.path() / "run");
  RecordedVehicle recorded(vehicle, recorder);
  fs::create_directory(folder.path() / "run" / "scans" / "000000300000000.pcd");
  try {
    heard_of(recorded);
    ADD_FAILURE() << "nothing was reported";
  } catch (const std::exception& e) {
    EXPECT_NE(std::string(e.what()).find("000000300000000.pcd: cannot be written"), std::string::npos)
        << e.what();
  }
  EXPECT_TRUE(vehicle.finished);
  EXPECT_EQ(scans_in(folder.path() / "run" / "scans"), 20u);
}

}  // namespace
}  // namespace karst::flight
