#include "plugins/lidar_drivers/ouster/sweep_assembler.h"

#include <gtest/gtest.h>

#include "core_stack/localization/sweep.h"
#include "plugins/simulator/sensors/lidar.h"
#include "tests/unit/lidar_drivers/units.h"
#include "tests/unit/simulator/meshes.h"

namespace {

using namespace karst;
using namespace karst::lidar;
using core::kMillisecond;

struct OusterBench {
  OusterMetadata metadata;
  std::shared_ptr<core::LidarModel> model;
  OusterSweepAssembler assembler;
  std::vector<RawSweep> sweeps;

  explicit OusterBench(const OusterMetadata& m)
      : metadata(m), model(std::make_shared<core::LidarModel>(lidar_model(m, {}))), assembler(m, model) {}
  void take(const std::vector<Packet>& packets, core::TimeNs now = 0) {
    for (const Packet& p : packets) take(p, now);
  }
  void take(const Packet& p, core::TimeNs now = 0) {
    assembler.take(p, now);
    for (RawSweep& s : assembler.closed(now)) sweeps.push_back(std::move(s));
  }
  std::vector<Packet> packets(std::uint16_t id) const {
    return ouster_packets(test::room_scan(model, (id + 1) * 100 * kMillisecond), metadata, id);
  }
};

void expect_same(const core::LidarScan& got, const core::LidarScan& sent, double step_m) {
  ASSERT_EQ(got.range_m.size(), sent.range_m.size());
  int returns = 0;
  for (std::size_t i = 0; i < sent.range_m.size(); ++i) {
    if (!std::isfinite(sent.range_m[i])) {
      EXPECT_TRUE(std::isnan(got.range_m[i]));  // the packet does not say why there is no return
      continue;
    }
    ++returns;
    // Rounded to 1 mm from the axis, then to the profile's step.
    EXPECT_NEAR(got.range_m[i], sent.range_m[i], step_m / 2 + (step_m > 0.001 ? 5e-4 : 0) + 1e-5) << i;
    EXPECT_NEAR(got.intensity[i], std::min(sent.intensity[i], 1.0f), 0.0052);
  }
  EXPECT_GT(returns, 400);
}

TEST(OusterSweeps, APacketedSweepIsTheSweepInEachProfile) {
  for (const auto& profile : names_of(OusterProfile{})) {
    OusterBench b(test::uneven_ouster(profile.value));
    const core::LidarScan sent = test::room_scan(b.model, 300 * kMillisecond);
    b.take(ouster_packets(sent, b.metadata, 9, 5'000'000'000));
    ASSERT_EQ(b.sweeps.size(), 1u);
    EXPECT_EQ(b.sweeps[0].sensor_ns, 5'300 * kMillisecond);
    EXPECT_TRUE(b.sweeps[0].scan.time_s.empty());
    expect_same(b.sweeps[0].scan, sent, profile.value == OusterProfile::low_data ? 0.008 : 0.001);
    EXPECT_EQ(b.assembler.counts(), (PacketCounts{.packets = 4, .scans = 1}));
  }
}

// A scan of the simulator, of each unit that Ouster makes, arrives as it was within a millimetre.
TEST(OusterSweeps, ASimulatedSweepArrivesAsItWas) {
  for (const char* unit : {"os0_32", "os1_64", "os0_128"}) {
    sim::LidarOptions o;
    o.unit = unit;
    const sim::Lidar lidar(o);
    const cave::Cave box = test::make_cave(test::box_mesh({-6, -4, -2}, {9, 5, 3}));
    const core::Pose turned{{1, 0.5, 0.2}, core::from_heading(0.3)};
    const core::LidarScan sent =
        lidar.sweep(box, {{0, {}}, {core::kSecond, turned}}, core::kSecond, core::Random(1));
    const auto& model = lidar.model();
    OusterBench b(metadata_for(*model, OusterProfile::single));
    b.take(ouster_packets(sent, b.metadata, 1));
    ASSERT_EQ(b.sweeps.size(), 1u) << unit;
    core::LidarScan& got = b.sweeps[0].scan;
    got.stamp = b.sweeps[0].sensor_ns;
    const core::Sweep a = core::to_sweep(sent, 0), c = core::to_sweep(got, 0);
    ASSERT_EQ(a.points.size(), c.points.size());
    ASSERT_GT(a.points.size(), 10000u);
    EXPECT_EQ(a.stamp, c.stamp);
    for (std::size_t i = 0; i < a.points.size(); ++i) {
      EXPECT_LT((a.points[i].position - c.points[i].position).norm(), 1e-3f);
      EXPECT_EQ(a.points[i].ring, c.points[i].ring);
      EXPECT_NEAR(a.points[i].time_s, c.points[i].time_s, 1e-7);
    }
  }
}

TEST(OusterSweeps, ColumnsKeepTheirOwnTimesIfTheMotorIsUneven) {
  OusterBench b(test::uneven_ouster(OusterProfile::single));
  core::LidarScan sent = test::room_scan(b.model, 0);
  for (int j = 0; j < 64; ++j)
    sent.time_s.push_back(static_cast<float>(-0.1 * (63 - j) / 64 + 0.002 * std::sin(j * 0.1) - 0.002));
  sent.time_s.back() = 0;
  b.take(ouster_packets(sent, b.metadata, 3, core::kSecond));
  ASSERT_EQ(b.sweeps.size(), 1u);
  EXPECT_EQ(b.sweeps[0].sensor_ns, core::kSecond);
  ASSERT_EQ(b.sweeps[0].scan.time_s.size(), 64u);
  for (std::size_t j = 0; j < 64; ++j) EXPECT_NEAR(b.sweeps[0].scan.time_s[j], sent.time_s[j], 1e-8);
}

TEST(OusterSweeps, AWindowOfColumnsIsACompleteSweep) {
  for (const auto& [first, last] : {std::pair{10, 40}, std::pair{50, 12}}) {
    OusterMetadata m = test::uneven_ouster(OusterProfile::legacy);
    m.first_column = first, m.last_column = last;
    OusterBench b(m);
    b.take(b.packets(0));
    ASSERT_EQ(b.sweeps.size(), 1u);
    EXPECT_EQ(b.assembler.counts().lost, 0u);
    for (int j = 0; j < 64; ++j)
      EXPECT_EQ(std::isnan(b.sweeps[0].scan.range_m[static_cast<std::size_t>(2 * 64 + j)]), !m.in_window(j))
          << j;
  }
}

TEST(OusterSweeps, OvertakenPacketsFindTheirSweep) {
  OusterBench b(test::uneven_ouster(OusterProfile::single));
  std::vector<Packet> one = b.packets(65535), two = b.packets(0);
  std::swap(one[1], one[2]);
  std::swap(one[3], two[0]);
  b.take(one);
  b.take(two);
  EXPECT_EQ(b.sweeps.size(), 2u);
  EXPECT_EQ(b.assembler.counts().lost, 0u);
  EXPECT_EQ(b.assembler.counts().malformed, 0u);
}

TEST(OusterSweeps, LostPacketsLeaveHolesAndAreCounted) {
  OusterBench b(test::uneven_ouster(OusterProfile::single));
  std::vector<Packet> one = b.packets(1);
  const core::LidarScan sent = test::room_scan(b.model, 200 * kMillisecond);
  one.erase(one.begin() + 3);  // the last: what tells the end is missing
  b.take(one, 0);
  EXPECT_TRUE(b.sweeps.empty());
  for (RawSweep& s : b.assembler.closed(49 * kMillisecond)) b.sweeps.push_back(std::move(s));
  EXPECT_TRUE(b.sweeps.empty());
  for (RawSweep& s : b.assembler.closed(51 * kMillisecond)) b.sweeps.push_back(std::move(s));
  ASSERT_EQ(b.sweeps.size(), 1u);
  EXPECT_EQ(b.sweeps[0].sensor_ns, 200 * kMillisecond);  // of the end that did not come
  EXPECT_EQ(b.assembler.counts().lost, 16u);
  for (std::size_t j = 0; j < 64; ++j) EXPECT_EQ(std::isnan(b.sweeps[0].scan.range_m[7 * 64 + j]), j >= 48);
  b.take(b.packets(4),
         100 * kMillisecond);  // two sweeps of which nothing came: believed from the third packet on
  EXPECT_EQ(b.assembler.counts().lost_scans, 2u);
}

TEST(OusterSweeps, TheNextSweepClosesOneThatIsNotComplete) {
  OusterBench b(test::uneven_ouster(OusterProfile::single));
  std::vector<Packet> one = b.packets(1);
  one.erase(one.begin());
  b.take(one);
  b.take(b.packets(2));
  ASSERT_EQ(b.sweeps.size(), 2u);
  EXPECT_EQ(b.sweeps[0].sensor_ns, 200 * kMillisecond);
  EXPECT_EQ(b.sweeps[1].sensor_ns, 300 * kMillisecond);
}

TEST(OusterSweeps, DuplicatesAndLatecomersChangeNothing) {
  OusterBench b(test::uneven_ouster(OusterProfile::single));
  std::vector<Packet> one = b.packets(7);
  std::vector<Packet> spoilt = one;
  for (std::size_t i = 60; i < spoilt[0].size(); ++i) spoilt[0][i] ^= 0x11;  // says otherwise: it came second
  b.take(one[0]);
  const OusterColumnHeader kept = OusterLayout(b.metadata).column(one[0], 0);
  Packet liar = one[0];
  OusterLayout(b.metadata).put_pixel(liar, 0, 0, {9999, 1});
  b.take(liar);
  b.take({one[1], one[2], one[3], one[2], liar});
  ASSERT_EQ(b.sweeps.size(), 1u);
  EXPECT_TRUE(kept.valid);
  EXPECT_NEAR(b.sweeps[0].scan.range_m[0], test::room_scan(b.model, 0).range_m[0], 0.001);
  EXPECT_EQ(b.assembler.counts().late, 3u);
}

TEST(OusterSweeps, CutForeignAndLyingPacketsAreCountedAndIgnored) {
  OusterBench b(test::uneven_ouster(OusterProfile::single));
  const std::vector<Packet> one = b.packets(7), next = b.packets(8);
  b.take(one[0]);
  Packet cut = one[1];
  cut.resize(cut.size() / 2);
  b.take(cut);
  b.take(Packet(1206, 0xff));  // of a Velodyne
  Packet column = one[1], stamp = one[1], frame = one[1];
  store<std::uint16_t>(column, 32 + 8, 64);  // there are 64 columns
  store<std::uint64_t>(stamp, 32, ~std::uint64_t{0});
  store<std::uint16_t>(frame, 2, 40000);
  b.take({column, stamp, frame});
  EXPECT_EQ(b.assembler.counts().foreign, 2u);
  EXPECT_EQ(b.assembler.counts().malformed, 3u);
  b.take({one[1], one[2], one[3]});
  b.take(next);
  ASSERT_EQ(b.sweeps.size(), 2u);
  EXPECT_EQ(b.assembler.counts().lost, 0u);
}

TEST(OusterSweeps, ASensorThatStartsAnewIsFollowed) {
  OusterBench b(test::uneven_ouster(OusterProfile::single));
  b.take(b.packets(30000));
  b.take(b.packets(2));
  b.take(b.packets(3));
  ASSERT_EQ(b.sweeps.size(), 3u);
  EXPECT_EQ(b.assembler.counts().lost, 32u);  // the first after the start lacks the two packets not believed
  EXPECT_EQ(b.assembler.counts().lost_scans, 0u);
}

}  // namespace
