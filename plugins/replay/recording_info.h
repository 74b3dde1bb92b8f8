// The file recording.info in a folder of scans: settings that the scans do not contain. docs/replay.md
#pragma once
#include <set>
#include <string>

#include "core_stack/common/geometry.h"
#include "core_stack/common/options.h"
#include "plugins/replay/bag/bag.h"
#include "plugins/replay/scan_files/scan_file.h"

namespace karst::replay {

/// The source of each scan's stamp.
enum class StampSource { rate, names, file };
constexpr auto names_of(StampSource) {
  using enum StampSource;
  return std::to_array<core::Named<StampSource>>({{rate, "rate"}, {names, "names"}, {file, "file"}});
}

/// The moment of the sweep that the stamp refers to.
enum class StampMoment { start, end };
constexpr auto names_of(StampMoment) {
  using enum StampMoment;
  return std::to_array<core::Named<StampMoment>>({{start, "start"}, {end, "end"}});
}

/// The zero of each point's time: the start or end of its sweep, or the zero of the stamps.
enum class TimeOrigin { start, end, absolute };
constexpr auto names_of(TimeOrigin) {
  using enum TimeOrigin;
  return std::to_array<core::Named<TimeOrigin>>({{start, "start"}, {end, "end"}, {absolute, "absolute"}});
}

/// The sensor's direction of rotation seen from above.
enum class TurnDirection { none, clockwise, counterclockwise };
constexpr auto names_of(TurnDirection) {
  using enum TurnDirection;
  return std::to_array<core::Named<TurnDirection>>(
      {{none, "none"}, {clockwise, "clockwise"}, {counterclockwise, "counterclockwise"}});
}

/// How a point's ring is determined; automatic: by the field if there is one, else by elevation. none: the
/// LiDAR has no rings, such as a Mid-360.
enum class RingSource { automatic, field, elevation, order, none };
constexpr auto names_of(RingSource) {
  using enum RingSource;
  return std::to_array<core::Named<RingSource>>(
      {{automatic, "auto"}, {field, "field"}, {elevation, "elevation"}, {order, "order"}, {none, "none"}});
}

/// The unit of an IMU's specific force: Livox' drivers write g.
enum class ForceUnit { mps2, g };
constexpr auto names_of(ForceUnit) {
  using enum ForceUnit;
  return std::to_array<core::Named<ForceUnit>>({{mps2, "m/s2"}, {g, "g"}});
}

struct RecordingInfo {
  std::string scans = "*";
  bool compensated = false;

  FieldNames fields;
  std::string bin_fields = "x y z intensity", bin_types = "float32";
  std::string point_times_files, point_times_type = "float32";

  StampSource stamp_from = StampSource::rate;
  std::string stamp_file, stamp_unit = "s";
  StampMoment stamp_of = StampMoment::start;
  double stamp_rate_hz = 10;
  std::string time_unit = "auto";
  TimeOrigin time_of = TimeOrigin::start;
  TurnDirection time_direction = TurnDirection::none;
  double period_s = 0.1;

  std::string lidar_position = "0 0 0", lidar_rotation = "0 0 0";
  double min_range_m = 0.5, max_range_m = 120;
  RingSource rings_by = RingSource::automatic;
  std::int64_t rings = 0;  // 0: not given
  double lowest_rad = 0, highest_rad = 0;

  std::string imu_file, imu_columns = "t ax ay az wx wy wz", imu_unit = "s", imu_rotation = "0 0 0";
  ForceUnit imu_force_unit = ForceUnit::mps2;

  // Topics of a bag; auto: as karst finds out.
  std::string lidar_topic = "auto", imu_topic = "auto", truth_topic = "none";
};
void describe(core::OptionTable& t, RecordingInfo& o);

/// The texts above, parsed.
struct RecordingLayout {
  BinLayout bin;
  ValueType point_times_type = ValueType::float32;
  core::Pose T_body_lidar;
  core::Quat R_body_imu = core::Quat::Identity();
};

/// Reads and checks the file; keys that it lacks stay as in `info`. Throws InputError naming file, key, the
/// expected value and the nearest key.
RecordingInfo read_recording_info(const std::string& file, RecordingInfo info = {});
/// The keys that the file has, such as "lidar.position".
std::set<std::string> keys_in(const std::string& file);
/// Throws InputError if the keys do not fit each other.
void check_recording_info(const RecordingInfo& info, const std::string& file);
/// What a bag of these scans cannot say itself: times, mounting, range and rings.
RecordedSettings settings_for_bag(const RecordingInfo& info);
RecordingLayout layout_of(const RecordingInfo& info, const std::string& file);

}  // namespace karst::replay
