#include "plugins/lidar_drivers/ouster/metadata.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <initializer_list>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "core_stack/common/json_text.h"
#include "plugins/lidar_drivers/ouster/packet_layout.h"

namespace karst::lidar {
namespace {

using Json = nlohmann::json;
constexpr double kRadians = std::numbers::pi / 180;
constexpr int kMaxColumns = 8192, kMaxPixels = 256;
constexpr std::size_t kMaxDatagram = 65507;

/// Reads keys, which stand at the top in old metadata and in groups in newer ones.
class Reader {
 public:
  Reader(const Json& root, const std::string& source) : root_(root), source_(source) {}

  [[noreturn]] void fail(const std::string& key, const std::string& reason) const {
    throw core::InputError(source_, key, reason);
  }
  /// Null if it is in none of the groups nor at the top.
  const Json* find(std::initializer_list<const char*> groups, const char* key) const {
    for (const char* g : groups)
      if (const auto group = root_.find(g); group != root_.end() && group->is_object())
        if (const auto at = group->find(key); at != group->end()) return &*at;
    const auto at = root_.find(key);
    return at == root_.end() ? nullptr : &*at;
  }
  const Json& get(std::initializer_list<const char*> groups, const char* key) const {
    const Json* found = find(groups, key);
    if (!found) fail(key, "is missing");
    return *found;
  }
  int whole(const Json& j, const char* key, int low, int high) const {
    const double v = j.is_number() ? j.get<double>() : std::nan("");
    if (!(v >= low && v <= high) || v != std::floor(v))
      fail(key, "must be a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    return static_cast<int>(v);
  }
  double number(const Json& j, const char* key, double low, double high) const {
    const double v = j.is_number() ? j.get<double>() : std::nan("");
    if (!(v >= low && v <= high))
      fail(key, "must be a number from " + std::to_string(low) + " to " + std::to_string(high));
    return v;
  }
  std::string text(const Json& j, const char* key) const {
    if (!j.is_string()) fail(key, "must be a text");
    return j.get<std::string>();
  }
  std::vector<double> numbers(const Json& j, const char* key, std::size_t most, double low,
                              double high) const {
    if (!j.is_array() || j.empty() || j.size() > most)
      fail(key, "must be a list of 1 to " + std::to_string(most) + " numbers");
    std::vector<double> out;
    for (const Json& v : j) out.push_back(number(v, key, low, high));
    return out;
  }

 private:
  const Json& root_;
  const std::string& source_;
};

void read_transform(const Reader& in, const Json* j, const char* key, OusterMetadata::Transform& out) {
  if (!j) return;
  const std::vector<double> v = in.numbers(*j, key, out.size(), -1e5, 1e5);
  if (v.size() != out.size()) in.fail(key, "must have 16 numbers");
  std::copy(v.begin(), v.end(), out.begin());
  Eigen::Matrix3d R;
  R << v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10];
  if (!(R * R.transpose()).isIdentity(1e-3) || R.determinant() < 0)
    in.fail(key, "is no rotation and translation");
}

/// "1024x10": columns and revolutions a second.
void read_mode(const Reader& in, OusterMetadata& m) {
  const Json* j = in.find({"config_params", "sensor_config"}, "lidar_mode");
  if (!j) in.fail("lidar_mode", "is missing");
  const std::string mode = in.text(*j, "lidar_mode");
  const auto x = mode.find('x');
  int columns = 0, rate = 0;
  const char* const end = mode.data() + mode.size();
  const bool good = x != std::string::npos &&
                    std::from_chars(mode.data(), mode.data() + x, columns).ptr == mode.data() + x &&
                    std::from_chars(mode.data() + x + 1, end, rate).ptr == end && rate >= 1 && rate <= 40;
  if (!good) in.fail("lidar_mode", "is not \"COLUMNSxRATE\" but \"" + mode + "\"");
  if (columns != m.columns_per_frame)
    in.fail("lidar_mode",
            "\"" + mode + "\" contradicts columns_per_frame " + std::to_string(m.columns_per_frame));
  m.rate_hz = rate;
}

}  // namespace

OusterMetadata ouster_metadata_of(const std::string& json, const std::string& source) {
  const Json root = core::json_of(json);
  if (!root.is_object()) throw core::InputError(source, "", "is no JSON object");
  const Reader in(root, source);
  OusterMetadata m;
  if (const Json* j = in.find({"sensor_info"}, "prod_line")) m.product = in.text(*j, "prod_line");
  if (const Json* j = in.find({"sensor_info"}, "prod_sn")) {
    const std::string serial = in.text(*j, "prod_sn");
    const auto [end, error] = std::from_chars(serial.data(), serial.data() + serial.size(), m.serial);
    if (error != std::errc{} || end != serial.data() + serial.size() || m.serial >> 40 != 0)
      in.fail("prod_sn", "is not a serial number but \"" + serial + "\"");
  }

  const auto format = {"lidar_data_format", "data_format"};
  m.columns_per_frame = in.whole(in.get(format, "columns_per_frame"), "columns_per_frame", 1, kMaxColumns);
  m.columns_per_packet = in.whole(in.get(format, "columns_per_packet"), "columns_per_packet", 1, 128);
  m.first_column = 0, m.last_column = m.columns_per_frame - 1;
  if (const Json* j = in.find(format, "column_window")) {
    const auto window = in.numbers(*j, "column_window", 2, 0, m.columns_per_frame - 1);
    if (window.size() != 2) in.fail("column_window", "must have 2 numbers");
    m.first_column = static_cast<int>(window[0]), m.last_column = static_cast<int>(window[1]);
  }
  m.profile = OusterProfile::legacy;
  if (const Json* j = in.find({"lidar_data_format", "data_format", "config_params"}, "udp_profile_lidar")) {
    const std::string name = in.text(*j, "udp_profile_lidar");
    const auto profile = core::parse<OusterProfile>(name);
    if (!profile) in.fail("udp_profile_lidar", "\"" + name + "\" is not supported");
    m.profile = *profile;
  }
  read_mode(in, m);

  const auto beams = {"beam_intrinsics"};
  m.altitude_deg =
      in.numbers(in.get(beams, "beam_altitude_angles"), "beam_altitude_angles", kMaxPixels, -90, 90);
  m.azimuth_deg =
      in.numbers(in.get(beams, "beam_azimuth_angles"), "beam_azimuth_angles", kMaxPixels, -180, 180);
  if (m.azimuth_deg.size() != m.altitude_deg.size())
    in.fail("beam_azimuth_angles", "has not as many numbers as beam_altitude_angles");
  if (!std::is_sorted(m.altitude_deg.rbegin(), m.altitude_deg.rend()))
    in.fail("beam_altitude_angles", "must descend");
  const int pixels = in.whole(in.get(format, "pixels_per_column"), "pixels_per_column", 1, kMaxPixels);
  if (pixels != m.pixels())
    in.fail("pixels_per_column", "is not the number of beams, " + std::to_string(m.pixels()));
  if (OusterLayout(m).packet_bytes() > kMaxDatagram)
    in.fail("columns_per_packet", "makes packets larger than a datagram");
  if (const Json* j = in.find(beams, "lidar_origin_to_beam_origin_mm"))
    m.beam_origin_mm = in.number(*j, "lidar_origin_to_beam_origin_mm", 0, 1000);
  read_transform(in, in.find({"lidar_intrinsics"}, "lidar_to_sensor_transform"), "lidar_to_sensor_transform",
                 m.lidar_to_sensor);
  read_transform(in, in.find({"imu_intrinsics"}, "imu_to_sensor_transform"), "imu_to_sensor_transform",
                 m.imu_to_sensor);
  return m;
}

OusterMetadata read_ouster_metadata(const std::string& file) {
  return ouster_metadata_of(core::read_input(file, core::kMaxTextFileBytes), file);
}

std::string json_text_of(const OusterMetadata& m) {
  const std::string mode = std::to_string(m.columns_per_frame) + "x" + std::to_string(std::lround(m.rate_hz));
  std::vector<int> shifts;
  for (const double a : m.azimuth_deg)
    shifts.push_back(static_cast<int>(std::lround(a / 360 * m.columns_per_frame)));
  const Json json = {
      {"beam_intrinsics",
       {{"beam_altitude_angles", m.altitude_deg},
        {"beam_azimuth_angles", m.azimuth_deg},
        {"lidar_origin_to_beam_origin_mm", m.beam_origin_mm}}},
      {"config_params", {{"lidar_mode", mode}, {"udp_profile_lidar", core::name_of(m.profile)}}},
      {"imu_intrinsics", {{"imu_to_sensor_transform", m.imu_to_sensor}}},
      {"lidar_data_format",
       {{"column_window", {m.first_column, m.last_column}},
        {"columns_per_frame", m.columns_per_frame},
        {"columns_per_packet", m.columns_per_packet},
        {"pixel_shift_by_row", shifts},
        {"pixels_per_column", m.pixels()},
        {"udp_profile_lidar", core::name_of(m.profile)}}},
      {"lidar_intrinsics", {{"lidar_to_sensor_transform", m.lidar_to_sensor}}},
      {"sensor_info", {{"prod_line", m.product}, {"prod_sn", std::to_string(m.serial)}}}};
  return core::json_text(json, 1);
}

core::Pose pose_of(const OusterMetadata::Transform& t) {
  Eigen::Matrix3d R;
  R << t[0], t[1], t[2], t[4], t[5], t[6], t[8], t[9], t[10];
  return {core::Vec3(t[3], t[7], t[11]) / 1000, core::Quat(R).normalized()};
}

// Ouster's lidar frame: column m is fired when the encoder stands at -2 pi m / n, and beam i points at the
// azimuth -2 pi m / n - azimuth_i (Ouster SDK 0.11, make_xyz_lut). karst's lidar frame is the same, turned
// by pi about z:
//
//   pi - 2 pi m / n - azimuth_i = (pi - 2 pi (m + 1/2) / n) + (pi / n - azimuth_i)
core::LidarModel lidar_model(const OusterMetadata& m, const core::Pose& T_body_sensor) {
  core::LidarModel model;
  model.name = m.product;
  model.columns = m.columns_per_frame;
  for (const double a : m.altitude_deg) model.elevation_rad.push_back(static_cast<float>(a * kRadians));
  bool offset = false;
  for (const double a : m.azimuth_deg) {
    const double rad = std::numbers::pi / m.columns_per_frame - a * kRadians;
    model.azimuth_offset_rad.push_back(static_cast<float>(rad));
    offset = offset || std::abs(rad) > 1e-7;
  }
  if (!offset) model.azimuth_offset_rad.clear();
  model.beam_origin_m = static_cast<float>(m.beam_origin_mm / 1000);
  // Nominal values for dark rock, not read off a data sheet: to be checked against that of the unit.
  const auto is = [&](const char* line) { return m.product.starts_with(line); };
  model.min_range_m = 0.3f;
  model.max_range_m = is("OS-0") ? 35.0f : is("OS-2") ? 200.0f : 90.0f;
  model.period = core::from_seconds(1 / m.rate_hz);
  const core::Pose half_turn{core::Vec3::Zero(), core::Quat(0, 0, 0, 1)};
  model.T_body_lidar = T_body_sensor * pose_of(m.lidar_to_sensor) * half_turn;
  return model;
}

OusterMetadata metadata_for(const core::LidarModel& model, OusterProfile profile) {
  OusterMetadata m;
  m.product = "OS-1-" + std::to_string(model.channels());
  m.serial = 1;
  m.profile = profile;
  m.columns_per_frame = model.columns;
  while (model.columns % m.columns_per_packet != 0) m.columns_per_packet /= 2;
  m.last_column = model.columns - 1;
  m.rate_hz = 1 / core::seconds(model.period);
  for (std::size_t c = 0; c < model.elevation_rad.size(); ++c) {
    const double offset_rad =
        model.azimuth_offset_rad.empty() ? 0 : static_cast<double>(model.azimuth_offset_rad[c]);
    m.altitude_deg.push_back(static_cast<double>(model.elevation_rad[c]) / kRadians);
    m.azimuth_deg.push_back((std::numbers::pi / model.columns - offset_rad) / kRadians);
  }
  m.beam_origin_mm = 1000 * static_cast<double>(model.beam_origin_m);
  return m;
}

}  // namespace karst::lidar
