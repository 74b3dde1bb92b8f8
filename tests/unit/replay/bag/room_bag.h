// The walk through the room, as a recording: files that karst reads by themselves, and messages for a bag.
#pragma once
#include <cmath>
#include <filesystem>
#include <fstream>

#include "plugins/replay/bag/message_type.h"
#include "plugins/replay/scan_files/decimal_time.h"
#include "tests/unit/replay/bag/bag_writer.h"
#include "tests/unit/replay/room_walk.h"

namespace karst::test {

constexpr int kBagScans = 12;

inline core::TimeNs stamp_of_scan(int i) { return core::from_seconds(kBegin_s + i * kPeriod_s); }

/// As Ouster's driver has them: x y z, t (uint32, ns), ring (uint16).
inline std::string ouster_points(int i) {
  core::Random noise(static_cast<std::uint64_t>(i) + 1);
  const std::string raw = scan_at((i + 1) * kPeriod_s, noise);
  std::string points;
  for (std::size_t at = 0; at < raw.size(); at += 20) {
    points += raw.substr(at, 12);
    float t = 0, ring = 0;
    std::memcpy(&t, raw.data() + at + 12, 4);
    std::memcpy(&ring, raw.data() + at + 16, 4);
    put(points, static_cast<std::uint32_t>(std::lround(1e9 * static_cast<double>(t))));
    put(points, static_cast<std::uint16_t>(ring));
  }
  return points;
}
inline const std::vector<PointFieldSpec> kOusterFields = {
    {"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}, {"t", 12, 6}, {"ring", 16, 4}};

struct ImuLine {
  core::TimeNs stamp;
  std::array<double, 3> force, rate;
};
inline std::vector<ImuLine> imu_lines() {
  std::vector<ImuLine> lines;
  constexpr double h = 1e-3;
  for (int k = -100; k < 20 * kBagScans + 20; ++k) {
    const double t = 0.005 * k;
    const core::Pose a = pose_at(t - h), b = pose_at(t), c = pose_at(t + h);
    const core::Vec3 f = b.orientation.conjugate() *
                         ((c.position - 2 * b.position + a.position) / (h * h) + core::Vec3(0, 0, 9.81));
    const double rate =
        core::wrap_angle(core::heading_of(c.orientation) - core::heading_of(a.orientation)) / (2 * h);
    lines.push_back({core::from_seconds(kBegin_s + t), {f.x(), f.y(), f.z()}, {0, 0, rate}});
  }
  return lines;
}

struct Written {
  std::vector<WrittenTopic> topics;
  std::vector<WrittenMessage> messages;
};
/// Scans arrive 10 ms after their end, IMU samples at once.
inline Written written(Serializer::Kind kind) {
  const replay::Dialect dialect = kind == Serializer::ros1 ? replay::Dialect::ros1 : replay::Dialect::ros2;
  Written w;
  for (const auto& [topic, type] :
       {std::pair{"/os/points", "sensor_msgs/PointCloud2"}, {"/os/imu", "sensor_msgs/Imu"}})
    w.topics.push_back({topic, type, replay::known_definition(type, dialect)});
  for (int i = 0; i < kBagScans; ++i)
    w.messages.push_back(
        {0, stamp_of_scan(i + 1) + 10'000'000,
         point_cloud2(kind, stamp_of_scan(i), "os_sensor", kOusterFields, 18, ouster_points(i))});
  for (const ImuLine& l : imu_lines())
    w.messages.push_back({1, l.stamp, imu(kind, l.stamp, "os_sensor", l.force, l.rate)});
  std::stable_sort(w.messages.begin(), w.messages.end(),
                   [](const auto& a, const auto& b) { return a.time < b.time; });
  return w;
}

/// Scans as bare records, IMU samples and stamps as text, and their recording.info.
inline void write_room_files(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const auto write = [&](const std::string& name, const std::string& bytes) {
    std::ofstream(folder / name, std::ios::binary) << bytes;
  };
  std::string stamps, imu;
  for (int i = 0; i < kBagScans; ++i) {
    write("scan" + std::to_string(i) + ".bin", ouster_points(i));
    stamps += replay::decimal_seconds(stamp_of_scan(i)) + "\n";
  }
  for (const ImuLine& l : imu_lines()) {
    std::array<char, 300> line;
    std::snprintf(line.data(), line.size(), "%s %.17g %.17g %.17g %.17g %.17g %.17g\n",
                  replay::decimal_seconds(l.stamp).c_str(), l.force[0], l.force[1], l.force[2], l.rate[0],
                  l.rate[1], l.rate[2]);
    imu += line.data();
  }
  write("stamps.txt", stamps);
  write("imu.txt", imu);
  write("recording.info",
        "bin { fields \"x y z t ring\" types \"float32 float32 float32 uint32 uint16\" }\n"
        "stamp { from file file stamps.txt of start }\nimu { file imu.txt }\n");
}

}  // namespace karst::test
