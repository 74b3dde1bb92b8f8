// What a vehicle's sensors say. Every message carries the time of measurement.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core_stack/common/geometry.h"
#include "core_stack/common/time.h"

namespace karst::core {

/// Beams of a LiDAR. Lidar frame: x forward, y left, z up.
///
/// A spinning LiDAR has rings: channel c of column j of n points at azimuth pi - 2 pi (j + 0.5) / n
/// (clockwise seen from above, starting backwards), plus the channel's offset. A LiDAR without rings has no
/// columns: each scan says where its beams pointed.
struct LidarModel {
  std::string name;
  int columns = 0;  // 0: no rings
  std::vector<float>
      elevation_rad;  // one a channel, highest first; without rings: of the highest and lowest beam
  float min_range_m = 0.3f;
  float max_range_m = 100.0f;
  TimeNs period = 100 * kMillisecond;  // one sweep
  Pose T_body_lidar;
  std::vector<float> azimuth_offset_rad = {};  // one a channel, counter-clockwise; empty: none
  float beam_origin_m =
      0;  // beams leave the unit at this distance from the z axis, at their column's azimuth

  bool has_rings() const { return columns > 0; }
  int channels() const { return static_cast<int>(elevation_rad.size()); }
  Vec3f direction(int channel, int column) const;  // unit vector in the lidar frame
  Vec3f origin(int column) const;                  // where ranges count from, lidar frame
};

/// One sweep. With rings, arrays are channel-major: index = channel * columns + column. Without rings, there
/// is an element for each point, in firing order.
struct LidarScan {
  TimeNs stamp = 0;  // end of the sweep
  std::shared_ptr<const LidarModel> model;
  std::vector<float> range_m;    // +inf: nothing within max_range_m; NaN: no valid measurement
  std::vector<float> intensity;  // 0..1
  /// When each column, or each point without rings, was fired, relative to the stamp, <= 0. Empty: column j
  /// at -period + period * (j + 1) / columns.
  std::vector<float> time_s = {};
  std::vector<Vec3f> direction = {};  // without rings: unit vectors in the lidar frame, one a point

  /// When column j, or point j without rings, was fired.
  TimeNs fired(std::size_t j) const;
  /// Whether the arrays have the sizes that the model asks for; whatever the intensities.
  bool fits_model() const;
};

/// A depth camera, here with x along the optical axis, y left, z up. Pinhole.
struct CameraModel {
  std::string name;
  int width = 0, height = 0;
  double horizontal_fov_rad = 0, vertical_fov_rad = 0;
  float min_range_m = 0.2f;
  float max_range_m = 4.5f;
  TimeNs period = 100 * kMillisecond;
  Pose T_body_camera;

  Vec3f direction(int row, int column) const;  // unit vector in the camera frame; row 0 is the top
};

/// Row-major ranges along each pixel's ray (not depth along the axis); inf and NaN as for LidarScan.
struct DepthImage {
  TimeNs stamp = 0;
  std::shared_ptr<const CameraModel> model;
  std::vector<float> range_m;
};

struct ImuSample {
  TimeNs stamp = 0;
  Vec3 specific_force_mps2 = Vec3::Zero();  // body frame; at rest about (0, 0, 9.81)
  Vec3 body_rate_radps = Vec3::Zero();
};

struct MagnetometerSample {
  TimeNs stamp = 0;
  Vec3 field_ut = Vec3::Zero();  // body frame, microtesla
};

/// Height by air pressure, above where it was switched on; it drifts by decimetres.
struct BarometerSample {
  TimeNs stamp = 0;
  double height_m = 0;
};

/// A pose sensor such as motion capture, with noise, delay and drift.
struct PoseSample {
  TimeNs stamp = 0;  // when it was true; it arrives later
  Pose T_world_body;
};

struct BatteryStatus {
  TimeNs stamp = 0;
  double energy_left_wh = 0;
  double fraction_left = 1;
  double power_w = 0;
  double seconds_left = 0;  // at the recent mean power
};

}  // namespace karst::core
