#include <gtest/gtest.h>

#include "core_stack/common/random.h"
#include "plugins/lidar_drivers/livox/encoder.h"
#include "plugins/lidar_drivers/livox/frame_assembler.h"
#include "plugins/simulator/sensors/lidar.h"
#include "tests/unit/simulator/meshes.h"

namespace {

using namespace karst;
using namespace karst::lidar;
using core::kMillisecond;

/// Points all around in firing order, of which some have no return.
core::LidarScan frame_of_points(const std::shared_ptr<const core::LidarModel>& model, core::TimeNs stamp) {
  core::LidarScan scan{stamp, model, {}, {}};
  core::Random random(static_cast<std::uint64_t>(stamp));
  for (int i = 0; i < 20000; ++i) {
    if (random.uniform() < 0.1) continue;
    const double azimuth = random.uniform(-3.1, 3.1), elevation = random.uniform(-0.12, 0.9);
    scan.direction.push_back(core::Vec3f(static_cast<float>(std::cos(elevation) * std::cos(azimuth)),
                                         static_cast<float>(std::cos(elevation) * std::sin(azimuth)),
                                         static_cast<float>(std::sin(elevation))));
    scan.range_m.push_back(static_cast<float>(random.uniform(0.5, 60)));
    scan.intensity.push_back(static_cast<float>(random.uniform(0, 0.14)));
    scan.time_s.push_back(static_cast<float>(-0.1 + 5e-6 * i));
  }
  return scan;
}

struct LivoxBench {
  std::shared_ptr<const core::LidarModel> model = std::make_shared<const core::LidarModel>(mid360_model({}));
  LivoxFrameAssembler assembler{model};
  std::vector<RawFrame> frames;
  std::uint16_t count = 65000;
  LivoxEncoding encoding;

  std::vector<Packet> packets(int frame) {
    return livox_packets(frame_of_points(model, (frame + 1) * 100 * kMillisecond), encoding, count);
  }
  void take(const std::vector<Packet>& packets, core::TimeNs now = 0) {
    for (const Packet& p : packets) {
      assembler.take(p, now);
      collect(now);
    }
  }
  void collect(core::TimeNs now) {
    for (RawFrame& f : assembler.closed(now)) frames.push_back(std::move(f));
  }
};

TEST(Livox, APacketHasTheBytesOfTheProtocol) {
  LivoxHeader h;
  h.time_interval = 4750, h.count = 0x1234, h.timestamp_ns = 0x0102030405060708;
  const Packet p =
      livox_packet(h, std::vector<LivoxPoint>(96, {core::Vec3f(1.019f, -1.705f, 2.494f), 4, 0x10}));
  ASSERT_EQ(p.size(), 1380u);
  EXPECT_EQ((std::vector<int>(p.begin(), p.begin() + 11)),
            (std::vector<int>{0, 0x64, 0x05, 0x8e, 0x12, 96, 0, 0x34, 0x12, 0, 1}));
  EXPECT_EQ((std::vector<int>(p.begin() + 28, p.begin() + 36)), (std::vector<int>{8, 7, 6, 5, 4, 3, 2, 1}));
  // 1019, -1705 and 2494 mm, reflectivity 4, tag 0x10
  EXPECT_EQ((std::vector<int>(p.begin() + 36, p.begin() + 50)),
            (std::vector<int>{0xfb, 3, 0, 0, 0x57, 0xf9, 0xff, 0xff, 0xbe, 9, 0, 0, 4, 0x10}));
  // CRC-32 by its definition, bit by bit: polynomial 0x04c11db7, all reversed.
  std::uint32_t crc = 0xffffffff;
  for (std::size_t i = 28; i < p.size(); ++i) {
    crc ^= p[i];
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xedb88320u : 0u);
  }
  EXPECT_EQ(load<std::uint32_t>(p, 24), ~crc);
}

TEST(Livox, PointsOfEachTypeLieWhereTheProtocolPutsThem) {
  const core::Vec3f at(-3.21f, 4.56f, 1.23f);
  for (const auto& [data, bytes, step_m] :
       {std::tuple{LivoxData::cartesian_mm, 14u, 0.001f}, std::tuple{LivoxData::cartesian_cm, 8u, 0.01f},
        std::tuple{LivoxData::spherical, 10u, 0.0015f}}) {
    LivoxHeader h, got;
    h.data = data;
    const Packet p = livox_packet(h, {{at, 77, 1}, {core::Vec3f::Zero(), 0, 0}});
    EXPECT_EQ(p.size(), 36 + 2 * bytes);
    ASSERT_EQ(read_livox_header(p, got), LivoxVerdict::good);
    EXPECT_EQ(got.points, 2);
    EXPECT_LT((livox_point(p, got, 0).position - at).norm(), step_m);
    EXPECT_EQ(livox_point(p, got, 0).reflectivity, 77);
    EXPECT_EQ(livox_point(p, got, 0).tag, 1);
    EXPECT_EQ(livox_point(p, got, 1).position.norm(), 0);
  }
  // Spherical, by the table: depth 2 m, zenith 60 deg, azimuth 270 deg.
  LivoxHeader h, got;
  h.data = LivoxData::spherical;
  const Packet p = livox_packet(h, {{core::Vec3f(0, -std::sqrt(3.0f), 1), 0, 0}});
  EXPECT_EQ(load<std::uint32_t>(p, 36), 2000u);
  EXPECT_EQ(load<std::uint16_t>(p, 40), 6000);
  EXPECT_EQ(load<std::uint16_t>(p, 42), 27000);
}

TEST(Livox, ImuSamplesAreInGAndRadians) {
  core::ImuSample s{123'456'789, {0.5, -9.81, 2}, {0.1, -0.2, 3}};
  const Packet p = livox_imu_packet(s, 3);
  ASSERT_EQ(p.size(), 60u);
  EXPECT_FLOAT_EQ(load<float>(p, 36), 0.1f);
  EXPECT_FLOAT_EQ(load<float>(p, 52), static_cast<float>(-9.81 / 9.80665));
  LivoxHeader h;
  ASSERT_EQ(read_livox_header(p, h), LivoxVerdict::good);
  const auto again = livox_imu(p, h);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->stamp, s.stamp);
  EXPECT_LT((again->specific_force_mps2 - s.specific_force_mps2).norm(), 1e-5);
  EXPECT_LT((again->body_rate_radps - s.body_rate_radps).norm(), 1e-6);
}

TEST(Livox, APacketedFrameIsTheFrameInEachType) {
  for (const auto& [data, step_m] :
       {std::pair{LivoxData::cartesian_mm, 0.001f}, std::pair{LivoxData::cartesian_cm, 0.01f},
        std::pair{LivoxData::spherical, 0.012f}}) {
    LivoxBench b;
    b.encoding.data = data;
    const core::LidarScan sent = frame_of_points(b.model, 400 * kMillisecond);
    b.take(livox_packets(sent, b.encoding, b.count));
    b.take(b.packets(4));
    ASSERT_EQ(b.frames.size(), 1u);
    const core::LidarScan& got = b.frames[0].scan;
    EXPECT_EQ(b.frames[0].sensor_ns, 400 * kMillisecond);
    EXPECT_TRUE(got.fits_model());
    ASSERT_EQ(got.range_m.size(), sent.range_m.size());
    for (std::size_t i = 0; i < sent.range_m.size(); ++i) {
      EXPECT_LT((got.range_m[i] * got.direction[i] - sent.range_m[i] * sent.direction[i]).norm(), step_m);
      EXPECT_NEAR(got.time_s[i], sent.time_s[i], 2e-7);
      EXPECT_NEAR(got.intensity[i], sent.intensity[i], 0.0035);
    }
    EXPECT_EQ(b.assembler.counts().lost, 0u);
  }
}

// The simulator's Mid-360 sends its scans, and the driver makes the same scans of the packets.
TEST(Livox, ASimulatedFrameArrivesAsItWas) {
  sim::LidarOptions o;
  o.unit = "mid360";
  const sim::Lidar lidar(o);
  const cave::Cave box = test::make_cave(test::box_mesh({-6, -4, -2}, {9, 5, 3}));
  const sim::PoseTrack track{{0, {}}, {core::kSecond, {{1, 0.5, 0.2}, core::from_heading(0.3)}}};
  LivoxBench b;
  std::vector<core::LidarScan> sent;
  for (int i = 1; i <= 4; ++i) {
    sent.push_back(lidar.sweep(box, track, i * 100 * kMillisecond, core::Random(7)));
    b.take(livox_packets(sent.back(), b.encoding, b.count));
  }
  ASSERT_EQ(b.frames.size(), 3u);
  for (std::size_t f = 0; f < 3; ++f) {
    const core::LidarScan& got = b.frames[f].scan;
    EXPECT_EQ(b.frames[f].sensor_ns, sent[f].stamp);
    ASSERT_EQ(got.range_m.size(), sent[f].range_m.size());
    for (std::size_t i = 0; i < got.range_m.size(); ++i) {
      EXPECT_LT((got.range_m[i] * got.direction[i] - sent[f].range_m[i] * sent[f].direction[i]).norm(),
                1e-3f);
      EXPECT_NEAR(got.time_s[i], sent[f].time_s[i], 1e-8);
    }
  }
}

TEST(Livox, LostDuplicateAndOvertakenPacketsAreCounted) {
  LivoxBench b;
  std::vector<Packet> one = b.packets(0), two = b.packets(1);
  std::swap(one.back(), two.front());
  std::swap(one[10], one[11]);
  one.insert(one.begin() + 50, one[48]);
  one.erase(one.begin() + 100, one.begin() + 103);
  b.take(one);
  b.take(two);
  b.take(b.packets(2));
  ASSERT_EQ(b.frames.size(), 2u);
  EXPECT_EQ(b.assembler.counts().lost, 3u);
  EXPECT_EQ(b.assembler.counts().late, 1u);
  EXPECT_EQ(b.frames[1].scan.range_m.size(), frame_of_points(b.model, 200 * kMillisecond).range_m.size());
  EXPECT_TRUE(std::is_sorted(b.frames[0].scan.time_s.begin(), b.frames[0].scan.time_s.end()));
}

TEST(Livox, CutForeignAndLyingPacketsAreCountedAndIgnored) {
  LivoxBench b;
  const std::vector<Packet> one = b.packets(0);
  b.take({one[0], one[1]});
  Packet cut = one[2];
  cut.resize(700);
  Packet flipped = one[2], dots = one[2], far = one[2];
  flipped[300] ^= 4;
  dots[5] = 95;
  LivoxHeader future;
  future.timestamp_ns = 40'000'000'000'000;
  far = livox_packet(future, {{core::Vec3f(1, 1, 1), 0, 0}});
  b.take({cut, Packet(1206, 0xff), livox_imu_packet({}, 0), flipped, dots, far, {}});
  EXPECT_EQ(b.assembler.counts().foreign, 4u);
  EXPECT_EQ(b.assembler.counts().malformed, 3u);
  b.take({one.begin() + 2, one.end()});
  b.take(b.packets(1));
  ASSERT_EQ(b.frames.size(), 1u);
  EXPECT_EQ(b.assembler.counts().lost, 0u);
}

TEST(Livox, PointsThatTheSensorDoubtsAreLeftOut) {
  LivoxBench b;
  LivoxHeader h;
  std::vector<LivoxPoint> points;
  for (const int tag : {0, 1, 2, 4, 8, 16, 32})
    points.push_back({core::Vec3f(2, 0, 0), 50, static_cast<std::uint8_t>(tag)});
  b.take({livox_packet(h, points)});
  b.collect(core::kSecond);
  ASSERT_EQ(b.frames.size(), 1u);
  EXPECT_EQ(b.frames[0].scan.range_m.size(), 5u);  // all but glue (2) and particles (8) of low confidence
}

TEST(Livox, AClockThatWasSetIsFollowed) {
  LivoxBench b;
  b.take(b.packets(0));
  b.take(b.packets(20000));  // PTP has begun
  b.take(b.packets(20001));
  b.take(b.packets(20002));
  EXPECT_EQ(b.frames.size(), 3u);
  EXPECT_EQ(b.frames.back().sensor_ns, 20002 * 100 * kMillisecond);
}

}  // namespace
