// The same walk through a room in every kind of bag: the same trajectory, whatever the format.
#include <gtest/gtest.h>

#include "core_stack/common/error.h"
#include "plugins/replay/bag/bag_sensors.h"
#include "plugins/replay/bag/message_type.h"
#include "plugins/replay/decimal_time.h"
#include "plugins/replay/recording.h"
#include "plugins/replay/recording_source.h"
#include "plugins/replay/scan_file.h"
#include "sdk/evaluation/record/poses.h"
#include "sdk/replay/replay_run.h"
#include "tests/unit/replay/bag/bag_writer.h"
#include "tests/unit/replay/room_walk.h"

namespace karst::replay {
namespace {

using test::BagVariant;
using test::Folder;
using test::Serializer;
constexpr int kBagScans = 12;

core::TimeNs stamp_of_scan(int i) { return core::from_seconds(test::kBegin_s + i * test::kPeriod_s); }

/// As Ouster's driver has them: x y z, t (uint32, ns), ring (uint16).
std::string ouster_points(int i) {
  core::Random noise(static_cast<std::uint64_t>(i) + 1);
  const std::string raw = test::scan_at((i + 1) * test::kPeriod_s, noise);
  std::string points;
  for (std::size_t at = 0; at < raw.size(); at += 20) {
    points += raw.substr(at, 12);
    float t = 0, ring = 0;
    std::memcpy(&t, raw.data() + at + 12, 4);
    std::memcpy(&ring, raw.data() + at + 16, 4);
    test::put(points, static_cast<std::uint32_t>(std::lround(1e9 * static_cast<double>(t))));
    test::put(points, static_cast<std::uint16_t>(ring));
  }
  return points;
}
const std::vector<test::PointFieldSpec> kOusterFields = {
    {"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}, {"t", 12, 6}, {"ring", 16, 4}};

struct ImuLine {
  core::TimeNs stamp;
  std::array<double, 3> force, rate;
};
std::vector<ImuLine> imu_lines() {
  std::vector<ImuLine> lines;
  constexpr double h = 1e-3;
  for (int k = -100; k < 20 * kBagScans + 20; ++k) {
    const double t = 0.005 * k;
    const core::Pose a = test::pose_at(t - h), b = test::pose_at(t), c = test::pose_at(t + h);
    const core::Vec3 f = b.orientation.conjugate() *
                         ((c.position - 2 * b.position + a.position) / (h * h) + core::Vec3(0, 0, 9.81));
    const double rate =
        core::wrap_angle(core::heading_of(c.orientation) - core::heading_of(a.orientation)) / (2 * h);
    lines.push_back({core::from_seconds(test::kBegin_s + t), {f.x(), f.y(), f.z()}, {0, 0, rate}});
  }
  return lines;
}

struct Written {
  std::vector<test::WrittenTopic> topics;
  std::vector<test::WrittenMessage> messages;
};
/// Scans arrive 10 ms after their end, IMU samples at once.
Written written(Serializer::Kind kind) {
  const Dialect dialect = kind == Serializer::ros1 ? Dialect::ros1 : Dialect::ros2;
  Written w;
  for (const auto& [topic, type] : {std::pair{"/os/points", "sensor_msgs/PointCloud2"}, {"/os/imu", "sensor_msgs/Imu"}})
    w.topics.push_back({topic, type, known_definition(type, dialect)});
  for (int i = 0; i < kBagScans; ++i)
    w.messages.push_back({0, stamp_of_scan(i + 1) + 10'000'000,
                          test::point_cloud2(kind, stamp_of_scan(i), "os_sensor", kOusterFields, 18, ouster_points(i))});
  for (const ImuLine& l : imu_lines())
    w.messages.push_back({1, l.stamp, test::imu(kind, l.stamp, "os_sensor", l.force, l.rate)});
  std::stable_sort(w.messages.begin(), w.messages.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  return w;
}

struct Replayed {
  std::string trajectory;
  ReplaySummary summary;
  SensorStream::Damage damage;
};
Replayed replayed(const std::string& path, const Folder& dir, const std::string& name) {
  const RecordingSource source = open_source(path, "");
  const auto run = dir.path() / ("run_" + name);
  const ReplaySummary s = replay_recording(*source.sensors, {}, run, [](auto, const auto&, const auto&) { return true; });
  return {file_bytes((run / "trajectory.tum").string()), s, source.sensors->damage()};
}

/// The same scans and samples as files that karst read before it read bags.
std::string expected_trajectory() {
  Folder dir;
  std::filesystem::create_directory(dir.path() / "scans");
  std::string stamps, imu;
  for (int i = 0; i < kBagScans; ++i) {
    dir.write("scans/scan" + std::to_string(i) + ".bin", ouster_points(i));
    stamps += decimal_seconds(stamp_of_scan(i)) + "\n";
  }
  for (const ImuLine& l : imu_lines()) {
    std::array<char, 300> line;
    std::snprintf(line.data(), line.size(), "%s %.17g %.17g %.17g %.17g %.17g %.17g\n",
                  decimal_seconds(l.stamp).c_str(), l.force[0], l.force[1], l.force[2], l.rate[0], l.rate[1],
                  l.rate[2]);
    imu += line.data();
  }
  dir.write("scans/stamps.txt", stamps);
  dir.write("scans/imu.txt", imu);
  dir.write("scans/recording.info",
            "bin { fields \"x y z t ring\" types \"float32 float32 float32 uint32 uint16\" }\n"
            "stamp { from file file stamps.txt of start }\nimu { file imu.txt }\n");
  return replayed((dir.path() / "scans").string(), dir, "folder").trajectory;
}

TEST(BagReplay, EveryFormatGivesTheTrajectoryOfTheFiles) {
  const std::string expected = expected_trajectory();
  ASSERT_EQ(std::count(expected.begin(), expected.end(), '\n'), kBagScans);
  Folder dir;
  const auto expect_same = [&](const std::string& file, const std::string& name, bool cut = false) {
    const Replayed r = replayed(file, dir, name);
    EXPECT_TRUE(r.trajectory == expected) << name;
    EXPECT_GT(r.summary.imu_samples, 200u) << name;
    EXPECT_EQ(r.damage.count > 0, cut) << name << ": " << (r.damage.first.empty() ? "" : r.damage.first.front());
  };
  const Written one = written(Serializer::ros1), little = written(Serializer::cdr_little),
                big = written(Serializer::cdr_big);
  using enum Compression;
  for (const Compression c : {none, bz2, lz4})
    for (const bool index : {true, false}) {
      const std::string name = std::string("ros1_") + core::name_of(c) + (index ? "" : "_unindexed") + ".bag";
      expect_same(dir.write(name, test::ros1_bag(one.topics, one.messages, {c, index, 30})), name, !index);
    }
  for (const Compression c : {none, lz4, zstd})
    for (const bool index : {true, false}) {
      const std::string name = std::string("mcap_") + core::name_of(c) + (index ? "" : "_without_summary") + ".mcap";
      expect_same(dir.write(name, test::mcap_file(little.topics, little.messages, {c, index, 30})), name);
    }
  expect_same(dir.write("loose.mcap", test::mcap_file(big.topics, big.messages, {none, false, 0})), "loose.mcap");
  for (const bool index : {true, false}) {
    const std::string name = index ? "a.db3" : "b.db3", path = (dir.path() / name).string();
    test::write_db3(path, (index ? little : big).topics, (index ? little : big).messages, index);
    expect_same(path, name);
  }
}

/// Records in another order than that of time, as they are where several publishers are recorded.
TEST(BagReplay, MessagesOfChunksThatOverlapComeInTheOrderOfTime) {
  Written w = written(Serializer::cdr_little);
  for (std::size_t i = 0; i + 7 < w.messages.size(); i += 7) std::reverse(w.messages.begin() + static_cast<std::ptrdiff_t>(i), w.messages.begin() + static_cast<std::ptrdiff_t>(i + 7));
  Folder dir;
  const auto bag = open_bag(dir.write("a.mcap", test::mcap_file(w.topics, w.messages, {Compression::zstd, true, 5})));
  core::TimeNs last = 0;
  std::size_t count = 0;
  while (const auto m = bag->next()) {
    EXPECT_GE(m->time, last);
    last = m->time;
    ++count;
  }
  EXPECT_EQ(count, w.messages.size());
}

TEST(BagReplay, OfABagThatIsCutAnywhereTheBeginningIsRead) {
  Folder dir;
  const Written one = written(Serializer::ros1), little = written(Serializer::cdr_little);
  using enum Compression;
  const std::vector<std::pair<std::string, std::string>> files = {
      {"a.bag", test::ros1_bag(one.topics, one.messages, {lz4, true, 30})},
      {"b.bag", test::ros1_bag(one.topics, one.messages, {none, true, 30})},
      {"c.mcap", test::mcap_file(little.topics, little.messages, {zstd, true, 30})},
      {"d.mcap", test::mcap_file(little.topics, little.messages, {none, false, 0})}};
  for (const auto& [name, bytes] : files) {
    std::size_t before = 0;
    for (int part = 1; part <= 20; ++part) {
      const std::string path = dir.write(name, bytes.substr(0, bytes.size() * static_cast<std::size_t>(part) / 21));
      const auto bag = open_bag(path);
      std::size_t count = 0;
      while (bag->next()) ++count;
      EXPECT_GE(count, before) << name << " " << part;
      EXPECT_GE(bag->faults().count(), 1u) << name << " " << part;
      before = count;
    }
    EXPECT_GT(before, one.messages.size() * 9 / 10) << name;
    EXPECT_LE(before, one.messages.size()) << name;
  }
}

}  // namespace
}  // namespace karst::replay
