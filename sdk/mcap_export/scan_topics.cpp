#include "sdk/mcap_export/scan_topics.h"

#include <algorithm>
#include <cmath>

#include "core_stack/common/error.h"
#include "plugins/replay/recording.h"
#include "sdk/evaluation/record/table.h"
#include "sdk/mcap_export/flight_topics.h"
#include "sdk/mcap_export/point_cloud.h"
#include "sdk/mcap_export/ros_values.h"

namespace karst::mcap {
namespace {

namespace fs = std::filesystem;
using ros::PointType;

constexpr const char* kLidarFrame = "lidar";

/// Fields as Ouster's driver names them; the stamp is when the sweep began, from which t counts.
ros::PointCloud2 cloud_of(const replay::Scan& scan, const ros::Time& stamp) {
  ros::PointCloud2 cloud = scan.has_ring
                               ? ros::empty_cloud({stamp, kLidarFrame}, {{"x", PointType::float32},
                                                                         {"y", PointType::float32},
                                                                         {"z", PointType::float32},
                                                                         {"intensity", PointType::float32},
                                                                         {"t", PointType::uint32},
                                                                         {"ring", PointType::uint16}})
                               : ros::empty_cloud({stamp, kLidarFrame}, {{"x", PointType::float32},
                                                                         {"y", PointType::float32},
                                                                         {"z", PointType::float32},
                                                                         {"intensity", PointType::float32},
                                                                         {"t", PointType::uint32}});
  cloud.data.reserve(scan.points.size() * cloud.point_step);
  for (const replay::ScanPoint& p : scan.points) {
    for (int axis = 0; axis < 3; ++axis) ros::append(cloud, p.position[axis]);
    ros::append(cloud, p.intensity);
    ros::append(cloud, static_cast<std::uint32_t>(p.time));
    if (scan.has_ring) ros::append(cloud, p.ring);
  }
  return ros::finished(std::move(cloud));
}

template <class F>
void attempt(std::vector<std::string>& problems, const F& f) {
  try {
    f();
  } catch (const core::InputError& e) {
    problems.push_back(e.what());
  }
}

/// `next` until it throws: what is wrong with a file is reported, and ends its topic.
Source reporting(Source next, std::vector<std::string>& problems) {
  return [next = std::move(next), &problems, over = false]() mutable -> std::optional<StampedBytes> {
    if (over) return std::nullopt;
    try {
      if (auto message = next()) return message;
    } catch (const core::InputError& e) {
      problems.push_back(std::string(e.what()) + "; what follows it is left out");
    }
    over = true;
    return std::nullopt;
  };
}

Topic point_topic(const std::shared_ptr<const replay::Recording>& recording, const FlightClock& clock,
                  std::vector<std::string>& problems) {
  Topic topic = topic_of<ros::PointCloud2>(
      "/points", clock, recording->files.size(), [recording, clock](std::size_t i) {
        const replay::RecordedFile& f = recording->files[i];
        const double t_s = core::seconds(f.stamp);
        return std::pair(
            t_s, cloud_of(replay::read_scan(f.path.string(), recording->info.fields, recording->layout.bin),
                          clock.stamp(t_s)));
      });
  topic.next = reporting(std::move(topic.next), problems);
  return topic;
}

ros::Imu imu_of(const core::ImuSample& s, const FlightClock& clock) {
  ros::Imu out;
  out.header = {clock.stamp(core::seconds(s.stamp)), kBodyFrame};
  out.orientation_covariance[0] = -1;  // by the message's rule: no orientation
  out.angular_velocity = ros::vector3(s.body_rate_radps);
  out.linear_acceleration = ros::vector3(s.specific_force_mps2);
  return out;
}

Topic imu_topic(const std::shared_ptr<replay::ImuFile>& imu, const FlightClock& clock,
                std::vector<std::string>& problems) {
  return {
      "/imu", ros::schema_of<ros::Imu>(),
      reporting(
          [imu, clock]() -> std::optional<StampedBytes> {
            const auto sample = imu->next();
            if (!sample) return std::nullopt;
            return StampedBytes{clock.ns(core::seconds(sample->stamp)), ros::cdr_of(imu_of(*sample, clock))};
          },
          problems)};
}

Topic compass_topic(const fs::path& file, const FlightClock& clock, std::vector<std::string>& problems) {
  auto table = std::make_shared<const evaluation::Table>(evaluation::read_table(file, {}, problems));
  const std::vector<double>*t = table->column("t"), *x = table->column("x_ut"), *y = table->column("y_ut"),
        *z = table->column("z_ut");
  const std::size_t count = t && x && y && z ? table->rows : 0;
  return topic_of<ros::MagneticField>("/compass", clock, count, [table, clock, t, x, y, z](std::size_t i) {
    constexpr double kTesla = 1e-6;
    ros::MagneticField out;
    out.header = {clock.stamp((*t)[i]), kBodyFrame};
    out.magnetic_field = {kTesla * (*x)[i], kTesla * (*y)[i], kTesla * (*z)[i]};
    return std::pair((*t)[i], std::move(out));
  });
}

/// Pressure at a height above sea level in the troposphere of the International Standard Atmosphere (ISO
/// 2533): a barometer tells the height above where it was switched on by the same law.
double standard_pressure_pa(double height_m) {
  constexpr double kSeaLevel_pa = 101325, kSeaLevel_k = 288.15, kLapse_kpm = 0.0065, kExponent = 5.25588;
  return kSeaLevel_pa * std::pow(std::max(0.0, 1 - kLapse_kpm * height_m / kSeaLevel_k), kExponent);
}

Topic barometer_topic(const fs::path& file, const FlightClock& clock, std::vector<std::string>& problems) {
  auto table = std::make_shared<const evaluation::Table>(evaluation::read_table(file, {}, problems));
  const std::vector<double>*t = table->column("t"), *height = table->column("height_m");
  const std::size_t count = t && height ? table->rows : 0;
  return topic_of<ros::FluidPressure>("/barometer", clock, count, [table, clock, t, height](std::size_t i) {
    return std::pair((*t)[i], ros::FluidPressure{
                                  {clock.stamp((*t)[i]), kBodyFrame}, standard_pressure_pa((*height)[i]), 0});
  });
}

}  // namespace

std::vector<Topic> scan_topics(const evaluation::RunRecord& run, const FlightClock& clock,
                               std::vector<std::string>& problems) {
  const fs::path folder = run.directory / "scans";
  if (!fs::is_directory(folder)) return {};
  std::vector<Topic> topics;
  if (fs::exists(folder / "recording.info"))  // else the vehicle has no LiDAR
    attempt(problems, [&] {
      const auto recording = std::make_shared<const replay::Recording>(replay::open_recording(folder, ""));
      topics.push_back(static_transform(clock, kBodyFrame, kLidarFrame, recording->layout.T_body_lidar));
      topics.push_back(point_topic(recording, clock, problems));
    });
  attempt(problems, [&] {
    topics.push_back(
        imu_topic(std::make_shared<replay::ImuFile>((folder / "imu.csv").string(), "t ax ay az wx wy wz",
                                                    core::kSecond, core::Quat::Identity()),
                  clock, problems));
  });
  topics.push_back(compass_topic(folder / "compass.csv", clock, problems));
  if (fs::exists(folder / "barometer.csv"))
    topics.push_back(barometer_topic(folder / "barometer.csv", clock, problems));
  return topics;
}

replay::RecordedSettings recorded_settings(const evaluation::RunRecord& run) try {
  const fs::path file = run.directory / "scans/recording.info";
  if (!fs::exists(file)) return {};
  return replay::settings_for_bag(replay::read_recording_info(file.string()));
} catch (const core::InputError&) {
  return {};  // reported with the topics
}

}  // namespace karst::mcap
