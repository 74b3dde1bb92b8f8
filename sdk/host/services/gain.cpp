#include "sdk/host/services/gain.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "sdk/host/services/snapshot.h"

namespace karst::host {
namespace {

using core::Cell;
using core::CellKey;
using core::Vec3;

/// A cube of cells around the eye, copied from the map so that a ray reads one byte a cell.
class Window {
 public:
  Window(const core::VoxelMap& map, const CellKey& center, std::int32_t radius)
      : corner_{center.x - radius, center.y - radius, center.z - radius},
        edge_(2 * radius + 1),
        cells_(static_cast<std::size_t>(edge_) * static_cast<std::size_t>(edge_) *
                   static_cast<std::size_t>(edge_),
               Cell::unknown) {
    const CellKey high{center.x + radius, center.y + radius, center.z + radius};
    map.for_each_in_box(corner_, high, [&](const CellKey& k, Cell c) { *at(k) = c; });
  }

  Cell* at(const CellKey& k) {
    return cells_.data() + (k.x - corner_.x) + stride(1) * (k.y - corner_.y) + stride(2) * (k.z - corner_.z);
  }
  /// From a cell to its neighbour along an axis.
  std::ptrdiff_t stride(int axis) const {
    const std::ptrdiff_t edge = edge_;
    return axis == 0 ? 1 : axis == 1 ? edge : edge * edge;
  }

 private:
  CellKey corner_;
  std::int32_t edge_;
  std::vector<Cell> cells_;
};

/// Calls visit(cell, key) for the window's cells that a ray passes (Amanatides and Woo, 1987) until it
/// returns false. All lengths in cells; `direction` is unit.
template <class Visit>
void walk(Window& window, const Vec3& eye, const Vec3& direction, double furthest, Visit&& visit) {
  std::array<std::int32_t, 3> key{}, step{};
  std::array<std::ptrdiff_t, 3> stride{};
  std::array<double, 3> next{}, period{};  // length to the next border of each axis, and between borders
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double along = direction[axis], floor = std::floor(eye[axis]);
    key[a] = static_cast<std::int32_t>(floor);
    step[a] = along < 0 ? -1 : 1;
    stride[a] = step[a] * window.stride(axis);
    period[a] = along == 0 ? std::numeric_limits<double>::infinity() : std::abs(1.0 / along);
    next[a] = along == 0 ? period[a] : period[a] * (along < 0 ? eye[axis] - floor : floor + 1.0 - eye[axis]);
  }
  Cell* cell = window.at({key[0], key[1], key[2]});
  while (visit(*cell, key)) {
    // Branchless: which border comes next cannot be predicted.
    const std::size_t y_or_z = next[1] < next[2] ? 1 : 2;
    const std::size_t a = next[0] < next[y_or_z] ? 0 : y_or_z;
    if (next[a] > furthest) return;
    cell += stride[a];
    key[a] += step[a];
    next[a] += period[a];
  }
}

bool is_pinhole(const karst_sensor_t& s) {
  return s.kind == KARST_SENSOR_CAMERA || s.kind == KARST_SENSOR_RGB;
}

int steps_over(double low, double high, double step) {
  return std::max(1, static_cast<int>(std::ceil((high - low) / step)));
}

/// Evenly spaced values over [low, high], both included, at most `step` apart.
std::vector<double> spread(double low, double high, double step) {
  const int n = steps_over(low, high, step);
  std::vector<double> out;
  for (int i = 0; i <= n; ++i) out.push_back(low + (high - low) * i / n);
  return out;
}

}  // namespace

std::string sensor_fault(const karst_sensor_t& s) {
  constexpr double pi = std::numbers::pi;
  if (s.kind != KARST_SENSOR_LIDAR && !is_pinhole(s)) return "unknown kind of sensor";
  if (!(s.max_range_m > 0 && s.max_range_m <= KARST_MAX_GAIN_RANGE_M))
    return "max_range_m is not in (0, 60] m";
  if (!(s.min_range_m >= 0 && s.min_range_m < s.max_range_m)) return "min_range_m is not in [0, max_range_m)";
  if (!(s.low_elevation_rad >= -pi / 2 - 1e-9 && s.low_elevation_rad <= s.high_elevation_rad &&
        s.high_elevation_rad <= pi / 2 + 1e-9))
    return "the elevations are not a range within [-pi/2, pi/2]";
  const double widest = is_pinhole(s) ? 3.0 : 2 * pi + 1e-9;
  if (!(s.horizontal_fov_rad > 0 && s.horizontal_fov_rad <= widest))
    return "horizontal_fov_rad is out of range";
  if (is_pinhole(s) && !(s.low_elevation_rad > -1.5 && s.high_elevation_rad < 1.5))
    return "a camera sees less than 1.5 rad up or down";
  const karst_quaternion_t& q = s.T_body_sensor.orientation;
  if (!(std::abs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1.0) < 1e-6))
    return "T_body_sensor is not a unit quaternion";
  if (!(to_core(s.T_body_sensor.position).norm() <= KARST_MAX_SENSOR_OFFSET_M))  // NaN as well
    return "T_body_sensor is more than 10 m from the body, or not finite";
  return "";
}

std::string sensor_excess(const karst_sensor_t& s, double resolution_m) {
  constexpr double kRounding = 1e-9;  // 60 m at 0.2 m are 300 cells
  if (s.max_range_m / resolution_m > KARST_MAX_GAIN_RANGE_CELLS + kRounding)
    return "max_range_m is more than " + std::to_string(KARST_MAX_GAIN_RANGE_CELLS) + " cells of the map";
  if (!is_pinhole(s)) return "";  // all around at the longest range is 1.1 million rays
  const double step = resolution_m / s.max_range_m, half = std::tan(0.5 * s.horizontal_fov_rad);
  const double rows = steps_over(std::tan(s.low_elevation_rad), std::tan(s.high_elevation_rad), step) + 1.0;
  const double columns = steps_over(-half, half, step) + 1.0;
  if (rows * columns > KARST_MAX_GAIN_RAYS)
    return "a camera this wide needs more than " + std::to_string(KARST_MAX_GAIN_RAYS) +
           " rays at this range";
  return "";
}

SensorRays::SensorRays(const karst_sensor_t& s, double resolution_m)
    : min_range_m_(s.min_range_m), max_range_m_(s.max_range_m) {
  const karst_quaternion_t& q = s.T_body_sensor.orientation;
  T_body_sensor_ = {to_core(s.T_body_sensor.position), core::Quat(q.w, q.x, q.y, q.z)};
  const double step = resolution_m / s.max_range_m;
  if (is_pinhole(s)) {
    const double half = std::tan(0.5 * s.horizontal_fov_rad);
    for (const double up : spread(std::tan(s.low_elevation_rad), std::tan(s.high_elevation_rad), step))
      for (const double left : spread(-half, half, step))
        directions_.push_back(Vec3(1, left, up).normalized());
    return;
  }
  for (const double elevation : spread(s.low_elevation_rad, s.high_elevation_rad, step)) {
    const double circle = std::max(std::cos(elevation), 1e-3);
    for (const double azimuth :
         spread(-0.5 * s.horizontal_fov_rad, 0.5 * s.horizontal_fov_rad, step / circle))
      directions_.emplace_back(std::cos(elevation) * std::cos(azimuth),
                               std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  }
}

std::uint64_t SensorRays::newly_seen(const core::VoxelMap& map, const karst_viewpoint_t& from) const {
  const core::Pose T_world_sensor =
      core::Pose{to_core(from.position), core::from_heading(from.heading_rad)} * T_body_sensor_;
  const Vec3 eye = T_world_sensor.position / map.resolution_m();  // in cells, as all below
  const double nearest = min_range_m_ / map.resolution_m(), furthest = max_range_m_ / map.resolution_m();
  Window window(map, map.key_of(T_world_sensor.position), static_cast<std::int32_t>(furthest) + 2);
  std::uint64_t count = 0;
  for (const Vec3& direction : directions_) {
    walk(window, eye, T_world_sensor.orientation * direction, furthest,
         [&](Cell& c, const std::array<std::int32_t, 3>& k) {
           if (c != Cell::unknown) return c == Cell::free;
           c = Cell::free;  // counted once; as transparent as before
           const double away = (Vec3(k[0] + 0.5, k[1] + 0.5, k[2] + 0.5) - eye).norm();
           if (away >= nearest && away <= furthest) ++count;
           return true;
         });
  }
  return count;
}

}  // namespace karst::host
