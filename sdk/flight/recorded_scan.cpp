#include "sdk/flight/recorded_scan.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

#include "core_stack/common/euler_angles.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/little_endian.h"

namespace karst::flight {
namespace {

using core::append_bytes;
using core::LidarScan;
using core::Vec3;
using core::Vec3f;

std::uint32_t since_begin_ns(const LidarScan& scan, std::size_t fired) {
  const core::TimeNs t = scan.fired(fired) - sweep_begin(scan);
  return static_cast<std::uint32_t>(
      std::clamp<core::TimeNs>(t, 0, std::numeric_limits<std::uint32_t>::max()));
}

/// Calls f(index, position, number of the firing, ring) for each return.
template <class F>
void for_each_return(const LidarScan& scan, const F& f) {
  const core::LidarModel& model = *scan.model;
  if (!model.has_rings()) {
    for (std::size_t i = 0; i < scan.range_m.size(); ++i)
      if (std::isfinite(scan.range_m[i])) f(i, Vec3f(scan.range_m[i] * scan.direction[i]), i, 0);
    return;
  }
  for (int channel = 0; channel < model.channels(); ++channel)
    for (int column = 0; column < model.columns; ++column) {
      const auto i = static_cast<std::size_t>(channel * model.columns + column);
      if (std::isfinite(scan.range_m[i]))
        f(i, Vec3f(model.origin(column) + scan.range_m[i] * model.direction(channel, column)),
          static_cast<std::size_t>(column), channel);
    }
}

/// "roll pitch yaw" in degrees. (Adding zero makes zeros of negative ones.)
std::string rotation_text(const core::Quat& q) {
  const Vec3 degrees = core::euler_angles_of(q) * (180 / std::numbers::pi);
  return core::format_text("%.9g %.9g %.9g", degrees.x() + 0.0, degrees.y() + 0.0, degrees.z() + 0.0);
}

/// Of the float nearest to 0.3, "0.3".
std::string shortest_text(float v) {
  std::array<char, 32> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), v).ptr;
  return {buffer.data(), end};
}

}  // namespace

core::TimeNs sweep_begin(const LidarScan& scan) { return scan.stamp - scan.model->period; }

std::string pcd_of(const LidarScan& scan) {
  if (!scan.fits_model()) return {};
  const bool rings = scan.model->has_rings();
  std::string points;
  points.reserve(scan.range_m.size() * 22);
  std::size_t count = 0;
  for_each_return(scan, [&](std::size_t i, const Vec3f& p, std::size_t fired, int ring) {
    for (int axis = 0; axis < 3; ++axis) append_bytes(points, p[axis]);
    append_bytes(points, i < scan.intensity.size() ? scan.intensity[i] : 0.0f);
    append_bytes(points, since_begin_ns(scan, fired));
    if (rings) append_bytes(points, static_cast<std::uint16_t>(ring));
    ++count;
  });
  const std::string n = std::to_string(count);
  return std::string("# .PCD v0.7\nVERSION 0.7\nFIELDS x y z intensity t") + (rings ? " ring" : "") +
         "\nSIZE 4 4 4 4 4" + (rings ? " 2" : "") + "\nTYPE F F F F U" + (rings ? " U" : "") +
         "\nCOUNT 1 1 1 1 1" + (rings ? " 1" : "") + "\nWIDTH " + n +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA binary\n" + points;
}

std::string recording_info_of(const core::LidarModel& lidar) {
  const Vec3& p = lidar.T_body_lidar.position;
  return core::format_text(
      "scans \"*.pcd\"\nstamp { from names unit ns of start }\ntime { unit ns of start period \"%.9g s\" }\n"
      "lidar { position \"%.9g %.9g %.9g\" rotation \"%s\" min_range \"%s m\" max_range \"%s m\" }\n"
      "rings { by %s }\nimu { file imu.csv columns \"t ax ay az wx wy wz\" }\n",
      core::seconds(lidar.period), p.x(), p.y(), p.z(), rotation_text(lidar.T_body_lidar.orientation).c_str(),
      shortest_text(lidar.min_range_m).c_str(), shortest_text(lidar.max_range_m).c_str(),
      lidar.has_rings() ? "field" : "none");
}

}  // namespace karst::flight
