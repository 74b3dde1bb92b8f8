// What an Ouster sensor says of itself: the JSON of its HTTP interface (`/api/v1/sensor/metadata`), or the
// flat JSON of firmware before 2.x and of recordings.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core_stack/common/enum_names.h"
#include "core_stack/vehicle/messages.h"

namespace karst::lidar {

/// The formats of lidar packets, by Ouster's names.
enum class OusterProfile { legacy, single, dual, low_data };
constexpr auto names_of(OusterProfile) {
  using enum OusterProfile;
  return std::to_array<core::Named<OusterProfile>>({{legacy, "LEGACY"},
                                                    {single, "RNG19_RFL8_SIG16_NIR16"},
                                                    {dual, "RNG19_RFL8_SIG16_NIR16_DUAL"},
                                                    {low_data, "RNG15_RFL8_NIR8"}});
}

/// Angles in degrees and lengths in millimetres, as the sensor gives them.
struct OusterMetadata {
  std::string product = "OS-1-64";  // prod_line
  std::uint64_t serial = 0;         // prod_sn; 0: not known
  OusterProfile profile = OusterProfile::single;
  int columns_per_frame = 1024;
  int columns_per_packet = 16;
  int first_column = 0, last_column = 1023;       // column_window: only these are sent; it may wrap around
  double rate_hz = 10;                            // revolutions a second, of lidar_mode
  std::vector<double> altitude_deg, azimuth_deg;  // of each beam, highest first; azimuth clockwise from above
  double beam_origin_mm = 0;                      // lidar_origin_to_beam_origin_mm
  using Transform = std::array<double, 16>;       // row-major
  Transform lidar_to_sensor = {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  Transform imu_to_sensor = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

  int pixels() const { return static_cast<int>(altitude_deg.size()); }
  /// Columns that a frame should bring.
  int columns_in_window() const {
    return (last_column - first_column + columns_per_frame) % columns_per_frame + 1;
  }
  bool in_window(int column) const {
    return (column - first_column + columns_per_frame) % columns_per_frame < columns_in_window();
  }
};

/// Throws InputError naming the file, the key and the reason.
OusterMetadata read_ouster_metadata(const std::string& file);
OusterMetadata ouster_metadata_of(const std::string& json, const std::string& source);
/// As firmware 2.3 and later give it.
std::string json_text_of(const OusterMetadata& metadata);

/// What the core sees of it. `T_body_sensor`: the pose of Ouster's sensor frame, on the plane of the base.
core::LidarModel lidar_model(const OusterMetadata& metadata, const core::Pose& T_body_sensor);

/// Metadata of a sensor that measures as `model` does: for a simulated one. Its base lies at the lidar's
/// origin.
OusterMetadata metadata_for(const core::LidarModel& model, OusterProfile profile);

/// The rotation and translation (m) of a transform.
core::Pose pose_of(const OusterMetadata::Transform& transform);

}  // namespace karst::lidar
