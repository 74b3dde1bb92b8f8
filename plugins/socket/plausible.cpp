#include "plugins/socket/plausible.h"

#include <cmath>
#include <numbers>

namespace karst::socket {
namespace {

constexpr int kMaxColumns = 65536, kMaxChannels = 1024, kMaxBeams = 4'000'000;
constexpr int kMaxPixels = 16'000'000, kMaxCameras = 32;
constexpr core::TimeNs kShortestPeriod = core::kMillisecond, kLongestPeriod = 60 * core::kSecond;

bool finite(const core::Vec3& v) { return v.allFinite(); }
bool rotation(const core::Quat& q) {
  return q.coeffs().allFinite() && std::abs(q.norm() - 1) < 1e-6;  // written as doubles
}
bool pose(const core::Pose& T) { return finite(T.position) && rotation(T.orientation); }
bool within(double value, double low, double high) { return value >= low && value <= high; }  // NaN is not
bool ranges(float low_m, float high_m) { return low_m >= 0 && high_m > low_m && high_m <= 10000; }
bool period(core::TimeNs t) { return t >= kShortestPeriod && t <= kLongestPeriod; }

std::string implausible_lidar(const core::LidarModel& m) {
  if (m.columns < 0 || m.columns > kMaxColumns) return "columns: expected 0 (no rings) to 65536";
  if (m.channels() < 1 || m.channels() > kMaxChannels) return "elevation_rad: expected 1 to 1024 channels";
  if (!m.has_rings() && m.channels() != 2)
    return "elevation_rad: expected two without rings, of the highest and the lowest beam";
  if (static_cast<long>(m.columns) * m.channels() > kMaxBeams) return "columns: more than 4000000 beams";
  for (std::size_t i = 0; i < m.elevation_rad.size(); ++i) {
    if (!within(m.elevation_rad[i], -std::numbers::pi / 2, std::numbers::pi / 2))
      return "elevation_rad: expected -pi/2 to pi/2";
    if (i > 0 && m.elevation_rad[i] >= m.elevation_rad[i - 1])
      return "elevation_rad: expected the highest first";
  }
  if (!m.azimuth_offset_rad.empty() && m.azimuth_offset_rad.size() != m.elevation_rad.size())
    return "azimuth_offset_rad: expected none, or one a channel";
  for (const float offset : m.azimuth_offset_rad)
    if (!within(offset, -std::numbers::pi, std::numbers::pi)) return "azimuth_offset_rad: expected -pi to pi";
  if (!within(m.beam_origin_m, 0, 1)) return "beam_origin_m: expected 0 to 1";
  if (!ranges(m.min_range_m, m.max_range_m)) return "max_range_m: expected more than min_range_m";
  if (!period(m.period)) return "period: expected 1 ms to 60 s";
  if (!pose(m.T_body_lidar)) return "T_body_lidar: is no pose";
  return "";
}

std::string implausible_camera(const core::CameraModel& m) {
  if (m.width < 1 || m.height < 1 || static_cast<long>(m.width) * m.height > kMaxPixels)
    return "width, height: expected 1 to 16000000 pixels";
  for (const double fov : {m.horizontal_fov_rad, m.vertical_fov_rad})
    if (!within(fov, 0.01, std::numbers::pi - 0.01)) return "fov_rad: expected 0.01 to 3.13";
  if (!ranges(m.min_range_m, m.max_range_m)) return "max_range_m: expected more than min_range_m";
  if (!period(m.period)) return "period: expected 1 ms to 60 s";
  if (!pose(m.T_body_camera)) return "T_body_camera: is no pose";
  return "";
}

/// NaN and infinity have a meaning; a negative range has none.
std::string implausible_ranges(const std::vector<float>& range_m, std::size_t expected) {
  if (range_m.size() != expected)
    return "range_m: expected " + std::to_string(expected) + " ranges, got " + std::to_string(range_m.size());
  for (const float r : range_m)
    if (r < 0) return "range_m: is negative";
  return "";
}

struct Judge {
  const core::VehicleDescription& vehicle;

  std::string operator()(const auto&) const { return ""; }
  std::string operator()(const Pong& m) const {
    return is_plausible_time(m.received) && is_plausible_time(m.sent) ? "" : "sent: is no time";
  }
  std::string operator()(const core::ImuSample& m) const {
    return finite(m.specific_force_mps2) && finite(m.body_rate_radps) ? "" : "is no number";
  }
  std::string operator()(const core::MagnetometerSample& m) const {
    return finite(m.field_ut) ? "" : "field_ut: is no number";
  }
  std::string operator()(const core::BarometerSample& m) const {
    return std::isfinite(m.height_m) ? "" : "height_m: is no number";
  }
  std::string operator()(const core::PoseSample& m) const {
    if (!vehicle.pose_sensor) return "the vehicle has no pose sensor";
    return pose(m.T_world_body) ? "" : "T_world_body: is no pose";
  }
  std::string operator()(const core::BatteryStatus& m) const {
    if (!within(m.fraction_left, 0, 1)) return "fraction_left: expected 0 to 1";
    // What is left may be without end, if nothing is used.
    const bool numbers = std::isfinite(m.energy_left_wh) && std::isfinite(m.power_w) && m.seconds_left >= 0;
    return numbers ? "" : "is no number";
  }
  std::string operator()(const core::LidarScan& m) const {
    if (!vehicle.lidar) return "the vehicle has no LiDAR";
    const core::LidarModel& lidar = *vehicle.lidar;
    const auto columns = static_cast<std::size_t>(lidar.columns);
    const std::size_t beams = lidar.has_rings() ? columns * lidar.elevation_rad.size() : m.range_m.size();
    const std::size_t times = lidar.has_rings() ? columns : beams;
    if (beams > kMaxBeams) return "range_m: more than 4000000 beams";
    if (m.intensity.size() != beams) return "intensity: expected " + std::to_string(beams) + " values";
    for (const float i : m.intensity)
      if (!(i >= 0 && i <= 1)) return "intensity: expected 0 to 1";
    if (m.time_s.size() != times && !(m.time_s.empty() && lidar.has_rings()))
      return "time_s: expected " + std::to_string(times) + " times";
    for (const float t : m.time_s)
      if (!within(t, -2 * core::seconds(lidar.period), 0))
        return "time_s: expected at most two periods before";
    if (m.direction.size() != (lidar.has_rings() ? 0 : beams))
      return "direction: expected one a point without rings";
    for (const core::Vec3f& d : m.direction)
      if (!d.allFinite() || std::abs(d.norm() - 1) > 1e-3f) return "direction: is no unit vector";
    return implausible_ranges(m.range_m, beams);
  }
  std::string operator()(const Depth& m) const {
    if (m.camera >= vehicle.cameras.size()) return "camera: the vehicle has no such camera";
    const core::CameraModel& camera = *vehicle.cameras[m.camera];
    return implausible_ranges(m.image.range_m, static_cast<std::size_t>(camera.width) * camera.height);
  }
  std::string operator()(const core::RgbFrame& m) const {
    if (!vehicle.rgb) return "the vehicle has no colour camera";
    const core::CameraModel& camera = vehicle.rgb->camera;
    const std::size_t bytes = 3 * static_cast<std::size_t>(camera.width) * camera.height;
    return m.rgb.empty() || m.rgb.size() == bytes
               ? ""
               : "rgb: expected none or " + std::to_string(bytes) + " bytes";
  }
  std::string operator()(const Objects& m) const {
    const bool there = m.camera == kRgbCamera ? vehicle.rgb != nullptr : m.camera < vehicle.cameras.size();
    if (!there) return "camera: the vehicle has no such camera";
    for (const core::ObjectDetection& o : m.look.found) {
      if (o.kind == core::ObjectKind::none) return "kind: is none";
      if (!finite(o.direction) || std::abs(o.direction.norm() - 1) > 1e-6)
        return "direction: is no unit vector";
      if (!within(o.range_m, 0, 10000) || !within(o.confidence, 0, 1) || !within(o.range_sigma_m, 0, 1000) ||
          !within(o.bearing_sigma_rad, 0, 4))
        return "found: is no number, or out of range";
    }
    return "";
  }
};

}  // namespace

std::string implausible(const core::VehicleDescription& v) {
  if (!within(v.radius_m, 0.01, 10)) return "radius_m: expected 0.01 to 10";
  if (!within(v.mass_kg, 0.01, 1000)) return "mass_kg: expected 0.01 to 1000";
  if (!within(v.max_thrust_n, v.mass_kg * 9.81, 1e6)) return "max_thrust_n: expected more than its weight";
  if (!within(v.max_body_rate_radps, 0.1, 100)) return "max_body_rate_radps: expected 0.1 to 100";
  if (!pose(v.T_world_start)) return "T_world_start: is no pose";
  if (v.cameras.size() > kMaxCameras) return "cameras: more than 32";
  const auto named = [](const std::string& part, const std::string& why) {
    return why.empty() ? "" : part + ": " + why;
  };
  if (v.lidar)
    if (const std::string why = implausible_lidar(*v.lidar); !why.empty()) return named("lidar", why);
  for (const auto& camera : v.cameras)
    if (const std::string why = implausible_camera(*camera); !why.empty())
      return named("camera " + camera->name, why);
  if (v.rgb)
    if (const std::string why = implausible_camera(v.rgb->camera); !why.empty()) return named("rgb", why);
  if (v.rgb && !within(v.rgb->max_incidence_rad, 0, std::numbers::pi / 2))
    return "rgb: max_incidence_rad: expected 0 to pi/2";
  return "";
}

std::string implausible(const ToCore& message, const core::VehicleDescription& vehicle) {
  if (const core::TimeNs* stamp = stamp_of(message); stamp && !is_plausible_time(*stamp))
    return "stamp: is no time";
  return std::visit(Judge{vehicle}, message);
}

std::string implausible(const Hello& hello) {
  constexpr double kMaxClimb_m = 100;
  return within(hello.climb_m, 0, kMaxClimb_m) ? "" : "climb_m: expected 0 to 100";
}

std::string implausible(const core::Command& c) {
  if (!finite(c.rates.body_rate_radps) || !std::isfinite(c.rates.thrust_n)) return "rates: is no number";
  const core::Reference& r = c.reference;
  if (!is_plausible_time(r.stamp) || !is_plausible_time(c.state.stamp)) return "stamp: is no time";
  for (const core::Vec3& v : {r.position, r.velocity_mps, r.acceleration_mps2, r.jerk_mps3})
    if (!finite(v)) return "reference: is no number";
  if (!std::isfinite(r.heading_rad) || !std::isfinite(r.heading_rate_radps)) return "reference: is no number";
  const core::State& s = c.state;
  if (c.state_is_known &&
      !(finite(s.position) && finite(s.velocity_mps) && finite(s.body_rate_radps) && rotation(s.orientation)))
    return "state: is no number";
  return "";
}

}  // namespace karst::socket
