#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core_stack/common/error.h"
#include "plugins/lidar_drivers/lidar_driver_options.h"
#include "plugins/lidar_drivers/livox/encoder.h"
#include "plugins/lidar_drivers/livox_receiver.h"
#include "plugins/lidar_drivers/ouster/imu_packet.h"
#include "plugins/lidar_drivers/ouster_receiver.h"
#include "plugins/lidar_drivers/packet/mount.h"
#include "plugins/lidar_drivers/transport/udp.h"
#include "tests/unit/lidar_drivers/units.h"

namespace {

using namespace karst;
using namespace karst::lidar;
using core::kMillisecond;
using core::kSecond;

StampSource relative_clock() { return {ClockKind::relative, 0, {}}; }

TEST(Receivers, OustersScansAndImuComeInMissionTimeAndTheBodyFrame) {
  const OusterMetadata m = test::uneven_ouster(OusterProfile::dual);
  auto points = std::make_unique<PacketQueue>(), imu = std::make_unique<PacketQueue>();
  PacketQueue &to_points = *points, &to_imu = *imu;
  const core::Pose T_body_sensor{{0.1, 0, 0.2}, core::from_heading(std::numbers::pi / 2)};
  OusterReceiver r(m, T_body_sensor, std::move(points), std::move(imu), relative_clock());
  EXPECT_LT((r.model()->T_body_lidar.position - core::Vec3(0.1, 0, 0.23618)).norm(), 1e-9);
  const auto model = std::make_shared<core::LidarModel>(*r.model());
  const std::int64_t ahead = 77 * kSecond;
  to_imu.push(ouster_imu_packet({ahead, {}, {}}));
  EXPECT_TRUE(r.poll(0).empty());
  EXPECT_TRUE(r.take_imu().empty());  // nothing is known of the clock yet
  for (int i = 1; i <= 3; ++i) {
    const core::TimeNs end = 100 * i * kMillisecond;
    for (Packet& p : ouster_packets(test::room_scan(model, end), m, static_cast<std::uint16_t>(i), ahead))
      to_points.push(std::move(p));
    to_imu.push(ouster_imu_packet({end + ahead, {1, 0, 9}, {0, 0, 2}}));
    to_imu.push(ouster_imu_packet({end + ahead, {1, 0, 9}, {0, 0, 2}}));
    const auto scans = r.poll(end + kMillisecond);
    ASSERT_EQ(scans.size(), 1u);
    EXPECT_EQ(scans[0]->stamp, end + kMillisecond);  // the constant delay cannot be known
    const auto samples = r.take_imu();
    ASSERT_EQ(samples.size(), 1u);
    EXPECT_EQ(samples[0].stamp, end + kMillisecond);
    EXPECT_LT((samples[0].specific_force_mps2 - core::Vec3(0, 1, 9)).norm(), 1e-5);
  }
  EXPECT_TRUE(r.take_imu().empty());
}

TEST(Receivers, ASynchronizedSensorIsStampedByTheHostsClock) {
  auto points = std::make_unique<PacketQueue>();
  PacketQueue& to_points = *points;
  std::int64_t host = 1000 * kSecond;
  LivoxReceiver r({}, std::move(points), nullptr,
                  StampSource(ClockKind::ptp, 37 * kSecond, [&] { return host; }));
  core::LidarScan scan{100 * kMillisecond, r.model(), {5}, {0.1f}};
  scan.time_s = {-0.05f};
  scan.direction = {core::Vec3f::UnitX()};
  std::uint16_t count = 0;
  for (Packet& p : livox_packets(scan, {.clock_ahead_ns = 1036 * kSecond + 900 * kMillisecond}, count))
    to_points.push(std::move(p));
  r.poll(3 * kSecond);
  host += 30 * kMillisecond;
  const auto scans = r.poll(3030 * kMillisecond);
  ASSERT_EQ(scans.size(), 1u);  // it ended at 1037 s of the sensor's clock, 1000 s of the host's
  EXPECT_EQ(scans[0]->stamp, 3 * kSecond);
}

TEST(Receivers, PacketsComeThroughASocket) {
  UdpReceiver in({.port = 0});
  UdpSender out("127.0.0.1", in.port());
  const Packet big(33024, 7);
  out.send(big);
  out.send(Packet{1, 2, 3});
  std::vector<std::size_t> sizes;
  for (int i = 0; i < 1000 && sizes.size() < 2; ++i)
    in.receive([&](PacketView p) { sizes.push_back(p.size()); });
  EXPECT_EQ(sizes, (std::vector<std::size_t>{33024, 3}));
  UdpReceiver deaf({.port = 0, .sender = "192.0.2.1"});
  UdpSender stranger("127.0.0.1", deaf.port());
  stranger.send(big);
  int came = 0;
  for (int i = 0; i < 1000 && deaf.ignored() == 0; ++i) deaf.receive([&](PacketView) { ++came; });
  EXPECT_EQ(came, 0);
  EXPECT_EQ(deaf.ignored(), 1u);
}

// Nobody receives for a while: what the system's buffer does not hold is lost, and one call takes no more
// than it is told to.
TEST(Receivers, TheQueueIsBounded) {
  UdpReceiver in({.port = 0, .buffer_bytes = 1 << 16, .max_packets = 8});
  UdpSender out("127.0.0.1", in.port());
  for (int i = 0; i < 5000; ++i) out.send(Packet(1380));
  int calls = 0, came = 0, once = 0;
  do {
    once = 0;
    in.receive([&](PacketView) { ++once; });
    EXPECT_LE(once, 8);
    came += once, ++calls;
  } while (once > 0 && calls < 10000);
  EXPECT_GT(came, 0);
  EXPECT_LT(came, 5000);
}

std::string refusal(const LidarDriverOptions& o) {
  try {
    open_lidar(o, "mission.info", "mavlink.lidar");
    return "taken";
  } catch (const core::InputError& e) {
    return e.what();
  }
}

TEST(Receivers, OptionsThatCannotBeAreRefusedWithTheirReason) {
  EXPECT_EQ(open_lidar({}, "mission.info", "mavlink.lidar"), nullptr);
  LidarDriverOptions o;
  o.unit = LidarUnit::ouster;
  EXPECT_EQ(refusal(o),
            "mission.info: mavlink.lidar.metadata: is needed for an Ouster sensor: its beams differ from "
            "unit to unit");
  o.metadata = "/nowhere/metadata.json";
  EXPECT_TRUE(refusal(o).starts_with("mission.info: mavlink.lidar.metadata: /nowhere/metadata.json"))
      << refusal(o);
  o.mount = "0 0 1 0 0";
  EXPECT_NE(refusal(o).find("mission.info: mavlink.lidar.mount: is not"), std::string::npos);
  LidarDriverOptions livox;
  livox.unit = LidarUnit::livox_mid360;
  livox.address = "nobody";
  livox.port = 47311;
  EXPECT_EQ(refusal(livox),
            "mission.info: mavlink.lidar.address: \"nobody\" is not an address such as 192.168.1.10");
  UdpReceiver first({.port = 0});
  livox.address = "";
  livox.port = first.port();
  EXPECT_EQ(refusal(livox), "mission.info: mavlink.lidar.port: UDP port " + std::to_string(first.port()) +
                                ": Address already in use");
}

TEST(Receivers, AnOusterIsOpenedByItsMetadata) {
  const OusterMetadata m = test::uneven_ouster(OusterProfile::single);
  const auto file =
      std::filesystem::temp_directory_path() / ("karst_ouster_" + std::to_string(::getpid()) + ".json");
  std::ofstream(file) << json_text_of(m);
  const std::uint16_t port = UdpReceiver({.port = 0}).port();  // free a moment ago
  LidarDriverOptions o;
  o.unit = LidarUnit::ouster, o.metadata = file.string(), o.port = port, o.mount = "0 0 0 180 0 0";
  const auto receiver = open_lidar(o, "mission.info", "mavlink.lidar");
  std::filesystem::remove(file);
  EXPECT_LT((receiver->model()->T_body_lidar * core::Vec3(0, 0, 1) - core::Vec3(0, 0, -1.03618)).norm(),
            1e-9);
  UdpSender sensor("127.0.0.1", port);
  const auto model = std::make_shared<core::LidarModel>(*receiver->model());
  for (const Packet& p : ouster_packets(test::room_scan(model, kSecond), m, 4)) sensor.send(p);
  std::vector<std::shared_ptr<const core::LidarScan>> scans;
  for (int i = 0; i < 1000 && scans.empty(); ++i) scans = receiver->poll(2 * kSecond);
  ASSERT_EQ(scans.size(), 1u);
  EXPECT_EQ(scans[0]->model, receiver->model());
  EXPECT_EQ(receiver->counts(), (PacketCounts{.packets = 4, .scans = 1}));
}

TEST(Receivers, AMountTurnsByYawThenPitchThenRoll) {
  const core::Pose T = mount_of("f", "k", "1 2 3 0 90 90");
  EXPECT_LT((T * core::Vec3(1, 0, 0) - core::Vec3(1, 2, 2)).norm(), 1e-12);  // forward looks down
  EXPECT_LT((T * core::Vec3(0, 1, 0) - core::Vec3(0, 2, 3)).norm(), 1e-12);
}

}  // namespace
