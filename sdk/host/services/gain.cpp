#include "sdk/host/services/gain.h"

#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "core_stack/mapping/occupancy/voxel_reader.h"
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
        cells_(core::VoxelReader(map).classes(corner_,
                                              {center.x + radius, center.y + radius, center.z + radius})) {}

  Cell* at(const CellKey& k) {
    return cells_.data() + (k.x - corner_.x) + stride(1) * (k.y - corner_.y) + stride(2) * (k.z - corner_.z);
  }
  CellKey key_of(const Cell* cell) const {
    const auto index =
        static_cast<std::int32_t>(cell - cells_.data());  // KARST_MAX_GAIN_RANGE_CELLS allows it
    return {corner_.x + index % edge_, corner_.y + index / edge_ % edge_, corner_.z + index / edge_ / edge_};
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

/// `value` if the mask is all ones, 0 if it is zero.
double masked(double value, std::int64_t mask) {
  return std::bit_cast<double>(std::bit_cast<std::int64_t>(value) & mask);
}

/// One axis of a walk. All lengths in cells.
struct WalkAxis {
  std::ptrdiff_t stride = 0;
  double next = 0, period = 0;  // length to the next border, and between borders

  WalkAxis(const Window& window, int axis, double from, double along)
      : stride((along < 0 ? -1 : 1) * window.stride(axis)) {
    const double floor = std::floor(from);
    period = along == 0 ? std::numeric_limits<double>::infinity() : std::abs(1.0 / along);
    next = along == 0 ? period : period * (along < 0 ? from - floor : floor + 1.0 - from);
  }
  /// Crosses the border if the mask is all ones; returns what to add to the cell.
  std::ptrdiff_t cross(std::int64_t mask) {
    next += masked(period, mask);
    return stride & mask;
  }
};

/// Calls visit(cell) for the window's cells that a ray passes (Amanatides and Woo, 1987) until it returns
/// false. All lengths in cells; `direction` is unit.
template <class Visit>
void walk(Window& window, const Vec3& eye, const Vec3& direction, double furthest, Visit&& visit) {
  const auto floor_of = [](double v) { return static_cast<std::int32_t>(std::floor(v)); };
  WalkAxis x(window, 0, eye.x(), direction.x()), y(window, 1, eye.y(), direction.y()),
      z(window, 2, eye.z(), direction.z());
  Cell* cell = window.at({floor_of(eye.x()), floor_of(eye.y()), floor_of(eye.z())});
  while (visit(cell)) {
    // Without a branch: which border comes next cannot be predicted.
    const bool y_before_z = y.next < z.next;
    const double y_or_z = y_before_z ? y.next : z.next;
    const bool x_first = x.next < y_or_z;
    if ((x_first ? x.next : y_or_z) > furthest) return;
    const std::int64_t x_mask = -std::int64_t{x_first}, y_mask = -std::int64_t{y_before_z} & ~x_mask;
    cell += x.cross(x_mask) + y.cross(y_mask) + z.cross(~(x_mask | y_mask));
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
    walk(window, eye, T_world_sensor.orientation * direction, furthest, [&](Cell* cell) {
      if (*cell != Cell::unknown) return *cell == Cell::free;
      *cell = Cell::free;  // counted once; as transparent as before
      const CellKey k = window.key_of(cell);
      const double away = (Vec3(k.x + 0.5, k.y + 0.5, k.z + 0.5) - eye).norm();
      if (away >= nearest && away <= furthest) ++count;
      return true;
    });
  }
  return count;
}

}  // namespace karst::host
