// The vehicle `mavlink` as a plugin: what it refuses, and that it hears an autopilot and a LiDAR by UDP.
#include <map>
#include <utility>

#include "core_stack/vehicle/load_vehicle.h"
#include "plugins/lidar_drivers/transport/udp.h"
#include "plugins/mavlink/firmware.h"
#include "plugins/mavlink/link/udp_link.h"
#include "plugins/mavlink/wire/frame.h"
#include "tests/closed_loop/command.h"
#include "tests/unit/lidar_drivers/units.h"

namespace karst {
namespace {

using core::kMillisecond;
using core::kSecond;

TEST(MavlinkPlugin, NamesWhatIsWrongBeforeItFlies) {
  const std::string folder = fresh_folder("mavlink_refused").string();
  std::ofstream(folder + "/os.json") << lidar::json_text_of(
      test::uneven_ouster(lidar::OusterProfile::single));
  const std::string fly = "fly --quiet --no-report --out " + folder + "/run --set vehicle=mavlink ",
                    ouster =
                        "--real-time --set mavlink.lidar.unit=ouster --set mavlink.lidar.metadata=" + folder +
                        "/os.json --set mavlink.lidar.port=";
  const auto refused = [](const std::string& arguments, const std::string& words) {
    const Output out = run_karst(arguments);
    EXPECT_NE(out.code, 0) << arguments;
    EXPECT_TRUE(out.says(words)) << out.text;
  };
  refused(fly, "--real-time");
  refused(fly + "--real-time", "mavlink.lidar.unit");
  refused(fly + ouster + "17502 --set mavlink.link=udp:nowhere:14550", "nowhere");
  refused(fly + ouster + "17502 --set mavlink.link=serial:/no/such/line:57600", "/no/such/line");
  refused(fly + "--real-time --set mavlink.lidar.unit=ouster --set mavlink.lidar.metadata=/no/such.json",
          "/no/such.json");
}

/// A port that is free now.
std::uint16_t free_port() { return lidar::UdpReceiver({.port = 0}).port(); }

struct Heard final : core::VehicleSink {
  std::vector<std::shared_ptr<const core::LidarScan>> scans;
  std::vector<std::string> authority;
  std::vector<core::TimeNs> imu;
  void on_lidar(std::shared_ptr<const core::LidarScan> s) override { scans.push_back(std::move(s)); }
  void on_depth(std::shared_ptr<const core::DepthImage>) override {}
  void on_imu(const core::ImuSample& s) override { imu.push_back(s.stamp); }
  void on_magnetometer(const core::MagnetometerSample&) override {}
  void on_pose(const core::PoseSample&) override {}
  void on_battery(const core::BatteryStatus&) override {}
  void on_ground(core::TimeNs) override {}
  void on_lift_off(core::TimeNs) override {}
  void on_authority(core::TimeNs, core::Authority who, const std::string& why) override {
    authority.push_back(std::string(name_of(who)) + ": " + why);
  }
  void on_lost(core::TimeNs, core::MissionOutcome, const std::string&) override {}
};

/// Speaks as PX4 does on the bench: disarmed, with an IMU and an answer to each question for the time.
class Autopilot {
 public:
  explicit Autopilot(std::uint16_t port) : link_(mavlink::UdpLink::to("127.0.0.1", port)) {}
  void step(core::TimeNs now) {
    bytes_.clear();
    link_.receive(bytes_);
    parser_.add(bytes_);
    while (const auto frame = parser_.next())
      if (frame->is<mavlink::Timesync>() && frame->as<mavlink::Timesync>().tc1 == 0)
        send(mavlink::Timesync{now + kAhead, frame->as<mavlink::Timesync>().ts1, 1, 191});
    if (now % kSecond == 0)
      send(mavlink::Heartbeat{3u << 16, 2, 12, mavlink::kCustomMode, mavlink::kStandby, 3});
    mavlink::HighresImu imu;
    imu.time_usec = static_cast<std::uint64_t>((now + kAhead) / 1000);
    imu.zacc = -9.81f;
    imu.fields_updated = 0x3f;
    send(imu);
  }

 private:
  static constexpr core::TimeNs kAhead = 1234 * kSecond;
  template <class Message>
  void send(const Message& m) {
    auto frame = mavlink::frame_of(m, {1, 1});
    frame.sequence = sequence_++;
    link_.send(mavlink::to_wire(frame));
  }
  mavlink::UdpLink link_;
  mavlink::FrameParser parser_;
  std::vector<std::uint8_t> bytes_;
  std::uint8_t sequence_ = 0;
};

TEST(MavlinkPlugin, InRealTimeItHearsTheAutopilotAndDeliversTheScansOfAnOuster) {
  const std::string folder = fresh_folder("mavlink_real_time").string();
  const lidar::OusterMetadata metadata = test::uneven_ouster(lidar::OusterProfile::single);
  std::ofstream(folder + "/os.json") << lidar::json_text_of(metadata);
  const std::uint16_t link_port = free_port(), lidar_port = free_port();
  core::VehiclePlugin& plugin =
      core::load_vehicle("mavlink", std::string(KARST_BINARY_DIR) + "/lib/karst/vehicles");
  core::OptionTable table;
  plugin.describe_options(table);
  for (const auto& [key, value] :
       std::map<std::string, std::string>{{"link", "udp:" + std::to_string(link_port)},
                                          {"lidar.unit", "ouster"},
                                          {"lidar.metadata", folder + "/os.json"},
                                          {"lidar.port", std::to_string(lidar_port)}})
    table.set("test", key, value);
  core::VehicleSetup setup;
  setup.clock = core::Clock::real_time;
  setup.run_dir = folder;
  const auto vehicle = plugin.create(setup);
  EXPECT_EQ(vehicle->description().authority, core::Authority::pilot);
  EXPECT_TRUE(vehicle->description().takes_reference);
  ASSERT_TRUE(vehicle->description().lidar);
  EXPECT_EQ(vehicle->description().lidar->channels(), metadata.pixels());

  Heard heard;
  core::Executive executive(1, core::Clock::real_time);
  Autopilot autopilot(link_port);
  lidar::UdpSender ouster("127.0.0.1", lidar_port);
  const auto model = std::make_shared<core::LidarModel>(*vehicle->description().lidar);
  vehicle->start(executive, heard);
  executive.every("autopilot", 5 * kMillisecond, 5 * kMillisecond, [&] { autopilot.step(executive.now()); });
  std::uint16_t sweep = 0;
  core::LidarScan sent;
  executive.every("ouster", 100 * kMillisecond, 100 * kMillisecond, [&] {
    sent = test::room_scan(model, executive.now());
    for (const lidar::Packet& p : lidar::ouster_packets(sent, metadata, ++sweep)) ouster.send(p);
  });
  // As long as it takes on a busy machine.
  executive.run_until(60 * kSecond, [&] {
    return heard.scans.size() >= 3 && heard.imu.size() >= 20 && !heard.authority.empty() &&
           heard.authority.back() == "pilot: not armed";
  });
  vehicle->finish();

  ASSERT_GE(heard.scans.size(), 3u);
  ASSERT_GE(heard.imu.size(), 20u);
  EXPECT_TRUE(std::is_sorted(heard.imu.begin(), heard.imu.end()));
  EXPECT_LE(heard.imu.back(), executive.measured_now());
  const core::LidarScan& scan = *heard.scans.back();
  EXPECT_TRUE(scan.fits_model());
  std::size_t same = 0;
  for (std::size_t i = 0; i < scan.range_m.size(); ++i)
    same += std::abs(scan.range_m[i] - sent.range_m[i]) < 2e-3f ? 1 : 0;
  EXPECT_GT(same, scan.range_m.size() * 9 / 10) << "the room stands still";
  ASSERT_FALSE(heard.authority.empty());
  EXPECT_EQ(heard.authority.back(), "pilot: not armed");
  EXPECT_TRUE(std::filesystem::exists(folder + "/mavlink.json"));
}

}  // namespace
}  // namespace karst
