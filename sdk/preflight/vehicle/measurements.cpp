#include "sdk/preflight/vehicle/measurements.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "sdk/preflight/vehicle/median.h"

namespace karst::preflight {
namespace {

using core::seconds;
using core::TimeNs;
using core::Vec3;

/// The core was flown with an IMU at 200 Hz, scans at 10 Hz and a pose sensor at 50 Hz.
constexpr double kImu_hz = 200, kScan_hz = 10, kPose_hz = 50, kCompass_hz = 10, kBarometer_hz = 5,
                 kBattery_hz = 0.5;
constexpr double kSelfMargin_m = 0.05;

std::vector<SensorTimeline> timelines_of(const VehicleRecord& r) {
  std::vector<SensorTimeline> all;
  const auto add = [&](Sensor sensor, double required_hz, const std::vector<Arrival>& arrivals,
                       const std::string& name = "") {
    all.push_back({sensor, name, required_hz, timeline_of(arrivals, r.begin, r.end)});
  };
  const auto rate_of = [](TimeNs period) { return 1 / seconds(std::max<TimeNs>(period, 1)); };
  add(Sensor::imu, kImu_hz, r.imu_arrivals);
  if (r.vehicle.lidar)
    add(Sensor::lidar, std::max(kScan_hz, rate_of(r.vehicle.lidar->period)), r.lidar_arrivals);
  for (std::size_t i = 0; i < r.cameras.size(); ++i)
    add(Sensor::camera, rate_of(r.vehicle.cameras[i]->period), r.cameras[i].arrivals,
        r.vehicle.cameras[i]->name);
  if (r.vehicle.pose_sensor) add(Sensor::pose, kPose_hz, r.pose_arrivals);
  add(Sensor::magnetometer, kCompass_hz, r.magnetometer_arrivals);
  add(Sensor::barometer, kBarometer_hz, r.barometer_arrivals);
  add(Sensor::battery, kBattery_hz, r.battery_arrivals);
  return all;
}

/// The messages that came before or after `when`, by the arrivals beside them.
template <class Message>
std::vector<Message> part_of(const std::vector<Message>& messages, const std::vector<Arrival>& arrivals,
                             TimeNs from, TimeNs to) {
  std::vector<Message> part;
  for (std::size_t i = 0; i < messages.size(); ++i)
    if (arrivals[i].came > from && arrivals[i].came <= to) part.push_back(messages[i]);
  return part;
}

std::vector<VectorSample> fields_of(const std::vector<core::MagnetometerSample>& samples) {
  std::vector<VectorSample> fields;
  for (const core::MagnetometerSample& s : samples)
    if (s.field_ut.allFinite()) fields.push_back({s.stamp, s.field_ut});
  return fields;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double deviation_of(const std::vector<double>& values) {
  const double mean = mean_of(values);
  double squares = 0;
  for (const double v : values) squares += (v - mean) * (v - mean);
  return std::sqrt(squares / static_cast<double>(values.size()));
}

std::optional<CompassFigures> compass_at_rest(const std::vector<VectorSample>& fields, const Vec3& up) {
  if (fields.empty()) return {};
  CompassFigures c;
  Vec3 mean = Vec3::Zero();
  for (const VectorSample& f : fields) mean += f.v / static_cast<double>(fields.size());
  double squares = 0;
  for (const VectorSample& f : fields) squares += (f.v - mean).squaredNorm() / 3;
  c.strength_ut = mean.norm();
  c.noise_ut = std::sqrt(squares / static_cast<double>(fields.size()));
  if (mean.norm() > 0 && up.norm() > 0)
    c.dip_rad = std::asin(std::clamp(-mean.dot(up) / mean.norm() / up.norm(), -1.0, 1.0));
  return c;
}

void add_motion(CompassFigures& c, const std::vector<VectorSample>& fields,
                std::span<const Orientation> gyroscope, std::span<const Orientation> lidar) {
  if (fields.empty()) return;
  std::vector<double> strength;
  for (const VectorSample& f : fields) strength.push_back(f.v.norm());
  c.strength_spread = deviation_of(strength) / mean_of(strength);
  if (!gyroscope.empty()) c.by_gyroscope = axes_of_vectors(fields, gyroscope);
  if (!lidar.empty()) c.by_lidar = axes_of_vectors(fields, lidar);
}

std::optional<BarometerFigures> barometer_figures(const std::vector<core::BarometerSample>& samples) {
  if (samples.size() < 4) return {};
  std::vector<double> height_m, first_m, last_m;
  for (const core::BarometerSample& s : samples) height_m.push_back(s.height_m);
  const auto quarter = static_cast<std::ptrdiff_t>(height_m.size() / 4);
  first_m.assign(height_m.begin(), height_m.begin() + quarter);
  last_m.assign(height_m.end() - quarter, height_m.end());
  BarometerFigures b;
  b.drift_m = mean_of(last_m) - mean_of(first_m);
  b.noise_m = deviation_of(height_m);
  b.frozen = std::all_of(height_m.begin(), height_m.end(), [&](double h) { return h == height_m.front(); });
  return b;
}

std::vector<Orientation> shifted(std::vector<Orientation> track, TimeNs by) {
  for (Orientation& o : track) o.stamp += by;
  return track;
}

}  // namespace

VehicleMeasurements measure(const VehicleRecord& r, const MeasureOptions& o) {
  VehicleMeasurements m;
  m.vehicle = r.vehicle;
  m.rest_s = seconds(r.rest_end - r.begin);
  m.motion_s = seconds(r.end - r.rest_end);
  m.sensors = timelines_of(r);
  m.imu = imu_at_rest(part_of(r.imu, r.imu_arrivals, r.begin - 1, r.rest_end));
  const Vec3 up = m.imu.samples > 0 ? m.imu.mean_force_mps2 : Vec3(Vec3::UnitZ());
  if (!r.scans_at_rest.empty()) m.lidar = lidar_view(r.scans_at_rest, r.vehicle.radius_m);
  m.climb_m = o.climb_m;
  m.room = pad_room(r, up, o.climb_m);
  m.compass = compass_at_rest(
      fields_of(part_of(r.magnetometer, r.magnetometer_arrivals, r.begin - 1, r.rest_end)), up);
  m.barometer = barometer_figures(part_of(r.barometer, r.barometer_arrivals, r.begin - 1, r.rest_end));
  if (!r.battery.empty()) m.battery = r.battery.back();
  m.home_reserve_s = o.home_reserve_s;
  m.checks = r.checks;
  m.lifted_off = r.lifted_off;
  m.lost = r.lost;
  if (!r.has_motion()) return m;

  const std::vector<core::ImuSample> moved = part_of(r.imu, r.imu_arrivals, r.rest_end, r.end);
  const std::vector<Orientation> gyroscope = gyro_track(moved, m.imu.mean_rate_radps);
  const std::vector<Orientation> lidar =
      match_scans(r.scans_in_motion, r.vehicle.radius_m + kSelfMargin_m, o.loam);
  MotionFigures& motion = m.motion.emplace();
  motion.scans = static_cast<int>(r.scans_in_motion.size());
  motion.matched = static_cast<int>(lidar.size());
  motion.hand_eye = hand_eye(gyroscope, lidar);
  motion.gyroscope_axes = axes_of_gyroscope(moved, m.imu.mean_rate_radps);
  motion.clipped = clipped_fraction(moved);
  motion.lidar_rates = turn_rates(lidar);
  // As coarse as the LiDAR's: noise would hide the motion.
  std::vector<Orientation> sampled;
  for (const Orientation& at : gyroscope)
    if (sampled.empty() || at.stamp - sampled.back().stamp >= 100 * core::kMillisecond) sampled.push_back(at);
  motion.gyroscope_rates = turn_rates(sampled);
  if (m.compass) {
    const TimeNs delay = motion.hand_eye ? core::from_seconds(motion.hand_eye->delay_s) : 0;
    add_motion(*m.compass, fields_of(part_of(r.magnetometer, r.magnetometer_arrivals, r.rest_end, r.end)),
               gyroscope, motion.hand_eye ? shifted(lidar, -delay) : std::vector<Orientation>{});
  }
  return m;
}

MachineFacts machine_facts(const std::string& run_folder) {
  namespace fs = std::filesystem;
  MachineFacts facts;
  facts.run_folder = run_folder;
  std::error_code error;
  fs::path folder = fs::absolute(run_folder, error);
  while (!fs::exists(folder, error) && folder.has_relative_path()) folder = folder.parent_path();
  if (const fs::space_info space = fs::space(folder, error); !error) facts.free_bytes = space.available;
  // A computer without a clock of its own begins in 1970 or when its system was built.
  constexpr std::chrono::sys_days kBuilt = std::chrono::year{2025} / 1 / 1;
  facts.clock_plausible = std::chrono::system_clock::now() > kBuilt;
  return facts;
}

double scans_bytes_per_s(const VehicleRecord& record) {
  constexpr double kPointBytes = 22, kImuLineBytes = 100;  // of docs/replay.md's files, at most
  const auto& scans = record.scans_at_rest;
  if (scans.empty() || !scans.front()->model) return 0;
  const double scan_hz = 1 / core::seconds(scans.front()->model->period);
  std::size_t beams = 0;
  for (const auto& scan : scans) beams = std::max(beams, scan->range_m.size());
  const double duration_s = core::seconds(record.end - record.begin);
  const double imu_hz = duration_s > 0 ? static_cast<double>(record.imu.size()) / duration_s : 0;
  return scan_hz * static_cast<double>(beams) * kPointBytes + imu_hz * kImuLineBytes;
}

}  // namespace karst::preflight
