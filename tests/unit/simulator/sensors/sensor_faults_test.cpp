#include "plugins/simulator/sensors/sensor_faults.h"

#include "tests/unit/simulator/meshes.h"

namespace karst::test {
namespace {

using Kind = cave::Fault::Kind;
using Sensor = cave::Fault::Sensor;
using sim::SensorFaults;

TEST(SensorFaults, StrikeTheirSensorInTheirTimeOnlyAndAreToldOnce) {
  SensorFaults faults({{Sensor::lidar, Kind::lost, 2, 1}, {Sensor::imu, Kind::lost, 2, 0.5}});
  EXPECT_FALSE(faults.inject(Sensor::lidar, 1.9).lost());
  const auto first = faults.inject(Sensor::lidar, 2.0);
  EXPECT_TRUE(first.lost());
  EXPECT_EQ(first.begun, std::vector<std::string>{"lidar lost for 1.000 s"});
  const auto later = faults.inject(Sensor::lidar, 2.9);
  EXPECT_TRUE(later.lost());
  EXPECT_TRUE(later.begun.empty());
  EXPECT_FALSE(faults.inject(Sensor::lidar, 3.0).lost());
  EXPECT_FALSE(faults.inject(Sensor::magnetometer, 2.2).lost());
  EXPECT_TRUE(faults.inject(Sensor::imu, 2.2).lost());
}

TEST(SensorFaults, WithoutDurationTheyStrikeTheNextMessageAndNoOther) {
  SensorFaults faults({{Sensor::lidar, Kind::three_points, 2.05, 0}});
  EXPECT_TRUE(faults.inject(Sensor::lidar, 2.0).kinds.empty());
  EXPECT_EQ(faults.inject(Sensor::lidar, 2.1).kinds, std::vector{Kind::three_points});
  EXPECT_TRUE(faults.inject(Sensor::lidar, 2.2).kinds.empty());
}

core::LidarScan scan() {
  core::LidarScan s;
  s.stamp = core::kSecond;
  for (int i = 0; i < 60; ++i) {
    s.range_m.push_back(i % 5 == 0 ? std::numeric_limits<float>::infinity() : 1.0f + static_cast<float>(i));
    s.intensity.push_back(0.1f);
  }
  return s;
}

TEST(SensorFaults, SpoilScansAsTheySay) {
  core::LidarScan s = scan();
  sim::spoil(s, Kind::three_points);
  EXPECT_EQ(std::count_if(s.range_m.begin(), s.range_m.end(), [](float r) { return std::isfinite(r); }), 3);
  EXPECT_EQ(s.range_m.size(), 60u);
  s = scan();
  sim::spoil(s, Kind::nan);
  EXPECT_EQ(std::count_if(s.range_m.begin(), s.range_m.end(), [](float r) { return std::isnan(r); }), 30);
  EXPECT_EQ(std::count_if(s.intensity.begin(), s.intensity.end(), [](float r) { return std::isnan(r); }), 20);
  s = scan();
  sim::spoil(s, Kind::stamp_back);
  EXPECT_EQ(s.stamp, 750 * core::kMillisecond) << "before the scans of the last 200 ms";
  EXPECT_EQ(s.range_m, scan().range_m);
  s = scan();
  sim::spoil(s, Kind::stamp_ahead);
  EXPECT_EQ(s.stamp, 1250 * core::kMillisecond);
}

}  // namespace
}  // namespace karst::test
