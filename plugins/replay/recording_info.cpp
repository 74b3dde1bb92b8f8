#include "plugins/replay/recording_info.h"

#include <boost/property_tree/ptree.hpp>

#include "core_stack/common/error.h"
#include "core_stack/common/euler_angles.h"
#include "plugins/replay/scan_files/text_numbers.h"

namespace karst::replay {
namespace {

using core::InputError;
using core::Vec3;

Vec3 three_numbers(const std::string& file, const std::string& key, std::string_view text) {
  Vec3 v;
  const std::string all(text);
  for (double& number : v.reshaped())
    if (!to_number(next_word(text), number) || !std::isfinite(number))
      throw InputError(file, key, "expected three numbers, got \"" + all + "\"");
  if (!next_word(text).empty()) throw InputError(file, key, "expected three numbers, got \"" + all + "\"");
  return v;
}

/// Roll, pitch and yaw in degrees, about the fixed axes x, y, z in this order.
core::Quat rotation_of(const std::string& file, const std::string& key, const std::string& text) {
  return core::rotation_of_euler(three_numbers(file, key, text) * (std::numbers::pi / 180));
}

ValueType type_of(const std::string& file, const std::string& key, const std::string& name) {
  const auto type = type_named(name);
  if (!type)
    throw InputError(
        file, key, "expected a type such as float32, float64, uint8, uint16 or uint32, got \"" + name + "\"");
  return *type;
}

BinLayout bin_layout(const RecordingInfo& info, const std::string& file) {
  BinLayout layout{{}, {}};
  std::string_view names = info.bin_fields, types = info.bin_types;
  for (auto n = next_word(names); !n.empty(); n = next_word(names)) layout.names.emplace_back(n);
  for (auto t = next_word(types); !t.empty(); t = next_word(types))
    layout.types.push_back(type_of(file, "bin.types", std::string(t)));
  if (layout.types.size() == 1) layout.types.resize(layout.names.size(), layout.types.front());
  if (layout.types.size() != layout.names.size())
    throw InputError(file, "bin.types",
                     "expected one type for all, or one for each of the " +
                         std::to_string(layout.names.size()) + " bin.fields");
  std::vector<Role> roles;
  for (const std::string& n : layout.names) roles.push_back(role_of(n, info.fields));
  check_roles(roles, file, "bin.fields");
  return layout;
}

}  // namespace

void describe(core::OptionTable& t, RecordingInfo& o) {
  t.add("scans", o.scans, {}, "files of the folder, in the order of their names; * stands for any text");
  t.add("compensated", o.compensated, "the points of a scan are already as seen at its stamp");
  t.under("fields", [&o](core::OptionTable& f) {
    f.add("intensity", o.fields.intensity, {}, "name of this field, where it is not a usual one");
    f.add("time", o.fields.time, {}, "name of the field with each point's time, likewise");
    f.add("ring", o.fields.ring, {}, "name of the field with each point's ring, likewise");
  });
  t.under("bin", [&o](core::OptionTable& b) {
    b.add("fields", o.bin_fields, {}, "what the numbers of a .bin record are, others may have any name");
    b.add("types", o.bin_types, {}, "their types, or one type for all of them (little-endian)");
  });
  t.under("point_times", [&o](core::OptionTable& p) {
    p.add("files", o.point_times_files, {},
          "files of bare numbers, each point's time; * stands for what it stands for in scans");
    p.add("type", o.point_times_type, {}, "type of these numbers");
  });
  t.under("stamp", [&o](core::OptionTable& s) {
    s.add("from", o.stamp_from, "where each scan's stamp comes from");
    s.add("rate", o.stamp_rate_hz, "Hz", 0.01, 1000, "scans a second");
    s.add("file", o.stamp_file, {}, "text file, a line a scan; its first word is the stamp");
    s.add("unit", o.stamp_unit, {"s", "ms", "us", "ns"}, "of stamps in names and files");
    s.add("of", o.stamp_of, "the moment of the sweep that is stamped");
  });
  t.under("time", [&o](core::OptionTable& s) {
    s.add("unit", o.time_unit, {"auto", "s", "ms", "us", "ns"},
          "of each point's time; auto: ns if stored as whole numbers, else s");
    s.add("of", o.time_of,
          "what each point's time counts from: the start or end of its sweep, or as the stamps do");
    s.add("direction", o.time_direction,
          "where points have no time: the sensor's turn seen from above, from which it is worked out");
    s.add("period", o.period_s, "s", 0.001, 10, "of one turn");
  });
  t.under("lidar", [&o](core::OptionTable& l) {
    l.add("position", o.lidar_position, {}, "of the sensor in the body's frame, \"x y z\" in metres");
    l.add("rotation", o.lidar_rotation, {}, "sensor to body, \"roll pitch yaw\" in degrees");
    l.add("min_range", o.min_range_m, "m", 0.0, 100, "nearer points are left out");
    l.add("max_range", o.max_range_m, "m", 1, 1000, "farther points are left out");
  });
  t.under("rings", [&o](core::OptionTable& r) {
    r.add("by", o.rings_by,
          "how a point's ring is known; auto: by the field if there is one, else by elevation");
    r.add("count", o.rings, 0, 4096, "rings of the sensor, for elevation; 0: not said");
    r.add("lowest", o.lowest_rad, "rad", -1.6, 1.6, "elevation of the lowest ring");
    r.add("highest", o.highest_rad, "rad", -1.6, 1.6, "elevation of the highest ring");
  });
  t.under("imu", [&o](core::OptionTable& i) {
    i.add("file", o.imu_file, {}, "text or CSV, a line a sample; none: no IMU");
    i.add("columns", o.imu_columns, {},
          "order of t, ax ay az (specific force, m/s^2), wx wy wz (rates, rad/s); others may have any name");
    i.add("unit", o.imu_unit, {"s", "ms", "us", "ns"}, "of its stamps");
    i.add("rotation", o.imu_rotation, {}, "IMU to body, \"roll pitch yaw\" in degrees");
    i.add("force_unit", o.imu_force_unit, "of the specific force, in a bag");
  });
  t.under("bag", [&o](core::OptionTable& b) {
    b.add("lidar", o.lidar_topic, {}, "topic of the scans; auto: the only one that has scans");
    b.add("imu", o.imu_topic, {}, "topic of the IMU; auto: the LiDAR's; none: without");
    b.add("truth", o.truth_topic, {},
          "topic of poses from elsewhere, for karst evaluate only; none: without");
  });
}

RecordingInfo read_recording_info(const std::string& file, RecordingInfo info) {
  core::OptionTable table;
  describe(table, info);
  table.read(file, core::read_info(file));
  check_recording_info(info, file);
  if (info.stamp_from == StampSource::file && info.stamp_file.empty())
    throw InputError(file, "stamp.file", "expected the file that stamp.from asks for");
  return info;
}

void check_recording_info(const RecordingInfo& info, const std::string& file) {
  layout_of(info, file);
  if (info.rings > 1 && info.lowest_rad >= info.highest_rad)
    throw InputError(file, "rings.lowest", "must lie below rings.highest");
  if (info.rings_by == RingSource::elevation && info.rings == 0)
    throw InputError(file, "rings.count", "expected the number of rings, which rings.by elevation needs");
}

RecordedSettings settings_for_bag(const RecordingInfo& info) {
  RecordingInfo values = info, usual;
  core::OptionTable table, defaults;
  describe(table, values);
  describe(defaults, usual);
  RecordedSettings settings;
  for (std::size_t i = 0; i < table.rows().size(); ++i) {
    const core::OptionTable::Row& row = table.rows()[i];
    const std::string value = core::value_text(row);
    const bool always = row.key == "compensated" || row.key.starts_with("lidar.");
    const bool if_unusual = row.key.starts_with("time.") || row.key.starts_with("rings.");
    if (always || (if_unusual && value != core::value_text(defaults.rows()[i])))
      settings.emplace(row.key, value);
  }
  return settings;
}

std::set<std::string> keys_in(const std::string& file) {
  std::set<std::string> keys;
  for (const auto& [key, value] : core::leaves_of(core::read_info(file))) keys.insert(key);
  return keys;
}

RecordingLayout layout_of(const RecordingInfo& info, const std::string& file) {
  RecordingLayout layout;
  layout.bin = bin_layout(info, file);
  layout.point_times_type = type_of(file, "point_times.type", info.point_times_type);
  layout.T_body_lidar = {three_numbers(file, "lidar.position", info.lidar_position),
                         rotation_of(file, "lidar.rotation", info.lidar_rotation)};
  layout.R_body_imu = rotation_of(file, "imu.rotation", info.imu_rotation);
  return layout;
}

}  // namespace karst::replay
