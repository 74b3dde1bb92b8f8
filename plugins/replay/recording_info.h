// What a folder of recorded scans does not say of itself: the file recording.info in it. docs/replay.md
#pragma once
#include <string>

#include "core_stack/common/geometry.h"
#include "core_stack/common/options.h"
#include "plugins/replay/scan_file.h"

namespace karst::replay {

struct RecordingInfo {
  std::string scans = "*";
  bool compensated = false;

  FieldNames fields;
  std::string bin_fields = "x y z intensity", bin_types = "float32";
  std::string point_times_files, point_times_type = "float32";

  std::string stamp_from = "rate", stamp_file, stamp_unit = "s", stamp_of = "start";
  double stamp_rate_hz = 10;
  std::string time_unit = "auto", time_of = "start", time_direction = "none";
  double period_s = 0.1;

  std::string lidar_position = "0 0 0", lidar_rotation = "0 0 0";
  double min_range_m = 0.5, max_range_m = 120;
  std::string rings_by = "auto";
  std::int64_t rings = 0;  // not said
  double lowest_rad = 0, highest_rad = 0;

  std::string imu_file, imu_columns = "t ax ay az wx wy wz", imu_unit = "s", imu_rotation = "0 0 0";
};
void describe(core::OptionTable& t, RecordingInfo& o);

/// What the texts above mean.
struct RecordingLayout {
  BinLayout bin;
  ValueType point_times_type = ValueType::float32;
  core::Pose T_body_lidar;
  core::Quat R_body_imu = core::Quat::Identity();
};

/// Reads and checks. Throws InputError naming file, key, what was expected and the nearest key.
RecordingInfo read_recording_info(const std::string& file);
RecordingLayout layout_of(const RecordingInfo& info, const std::string& file);

}  // namespace karst::replay
