#include "sdk/host/services/gain.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "core_stack/mapping/occupancy/voxel_reader.h"
#include "sdk/host/services/snapshot.h"

namespace karst::host {
namespace {

using core::CellKey;
using core::Vec3;

// What a byte of the window says.
constexpr std::uint8_t kUnknownCell = 1, kRock = 2, kPassed = 4;

constexpr std::size_t kLanes = 4;  // rays that are walked at once

// Vectors of the compiler, because Eigen's are no wider than the whole program's instruction set.
using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));
using LaneInts = std::int64_t __attribute__((vector_size(kLanes * sizeof(double))));
using LogOdds = std::int16_t __attribute__((vector_size(core::kBlockEdge * sizeof(std::int16_t))));
using CellBytes = std::uint8_t __attribute__((vector_size(core::kBlockEdge)));

/// What the window says of eight cells of a row.
CellBytes bytes_of(const std::int16_t* log_odds) {
  LogOdds v;
  __builtin_memcpy(&v, log_odds, sizeof v);
  return __builtin_convertvector(((v == core::kUnknown) & kUnknownCell) | ((v >= 0) & kRock), CellBytes);
}

/// The cells of a box around the eye, copied from the map so that a ray reads one byte a cell. Along x it
/// begins and ends where the map's blocks do: their rows are copied whole.
class Window {
 public:
  /// Keeps the memory of an earlier one.
  Window(const core::VoxelMap& map, const CellKey& low, const CellKey& high, std::vector<std::uint8_t>& bytes)
      : corner_{low.x & ~kInRow, low.y, low.z},
        row_((high.x | kInRow) + 1 - corner_.x),
        rows_(high.y + 1 - low.y),
        layers_(high.z + 1 - low.z),
        bytes_(bytes) {
    bytes_.assign(static_cast<std::size_t>(stride(2)) * static_cast<std::size_t>(layers_), kUnknownCell);
    core::VoxelReader reader(map);
    for (const core::Block* b : core::blocks_in_box(reader.blocks(), low, high)) {
      const CellKey c = core::corner_of(b->id);
      for (std::int32_t z = std::max(c.z, low.z); z <= std::min(c.z + kInRow, high.z); ++z)
        for (std::int32_t y = std::max(c.y, low.y); y <= std::min(c.y + kInRow, high.y); ++y) {
          const CellBytes cells = bytes_of(b->log_odds.data() + core::local_of({c.x, y, z}));
          __builtin_memcpy(bytes_.data() + index_of({c.x, y, z}), &cells, sizeof cells);
        }
    }
  }

  std::uint8_t* bytes() { return bytes_.data(); }
  std::int64_t index_of(const CellKey& k) const {
    return (k.x - corner_.x) + stride(1) * (k.y - corner_.y) + stride(2) * (k.z - corner_.z);
  }
  /// From a cell to its neighbour along an axis.
  std::int64_t stride(int axis) const {
    const std::int64_t row = row_;
    return axis == 0 ? 1 : axis == 1 ? row : row * rows_;
  }
  /// Calls visit(key) for each unknown cell that was passed.
  template <class Visit>
  void for_each_seen(Visit&& visit) const {
    static_assert(std::endian::native == std::endian::little);
    constexpr std::uint64_t kEach = 0x0101010101010101u, kLow = 0x7f * kEach;
    const std::uint8_t* at = bytes_.data();
    for (std::int32_t z = 0; z < layers_; ++z)
      for (std::int32_t y = 0; y < rows_; ++y)
        for (std::int32_t x = 0; x < row_; x += kInRow + 1, at += kInRow + 1) {
          std::uint64_t eight = 0;
          std::memcpy(&eight, at, sizeof eight);
          eight ^= (kUnknownCell | kPassed) * kEach;
          // The highest bit of each byte that is zero now.
          for (std::uint64_t seen = ~(((eight & kLow) + kLow) | eight | kLow); seen != 0; seen &= seen - 1)
            visit(CellKey{corner_.x + x + std::countr_zero(seen) / 8, corner_.y + y, corner_.z + z});
        }
  }

 private:
  static constexpr std::int32_t kInRow = core::kBlockEdge - 1;

  CellKey corner_;
  std::int32_t row_, rows_, layers_;
  std::vector<std::uint8_t>& bytes_;
};

/// Where walks begin, and how far they lead. All lengths in cells.
struct WalkStart {
  Vec3 below, above;  // from the eye to the borders of its cell
  std::int64_t cell = 0;
  std::array<std::int64_t, 3> stride{};
  double furthest = 0;
};

/// One axis of the walks.
struct WalkAxis {
  Lanes next, period;  // length to the next border, and between borders
  LaneInts stride;

  [[gnu::always_inline]] WalkAxis(const WalkStart& start, int axis, const Lanes& along) {
    const std::int64_t up = start.stride[static_cast<std::size_t>(axis)];
    const LaneInts back = along < 0;
    const Lanes inverse = 1.0 / along;  // infinite where the ray meets no border
    period = inverse < 0 ? -inverse : inverse;
    const Lanes first = period * (back ? Lanes{} + start.below[axis] : Lanes{} + start.above[axis]);
    next = along == 0 ? Lanes{} + std::numeric_limits<double>::infinity() : first;
    stride = back ? LaneInts{} - up : LaneInts{} + up;
  }
  /// Crosses the border where the mask is all ones, and adds to `steps` what that moves the cell.
  [[gnu::always_inline]] void cross(const LaneInts& mask, LaneInts& steps) {
    next += reinterpret_cast<Lanes>(reinterpret_cast<LaneInts>(period) & mask);
    steps |= stride & mask;
  }
};

/// Marks a cell; returns what it was.
[[gnu::always_inline]] inline std::uint8_t pass(std::uint8_t* cell) {
  const std::uint8_t was = *cell;
  *cell = was | kPassed;
  return was;
}

/// Marks the cells that the rays pass (Amanatides and Woo, 1987) up to the first one of rock. A ray that has
/// ended stands where it is, and marks its last cell again.
[[gnu::always_inline]] inline void walk(std::uint8_t* bytes, const WalkStart& start, const double* directions,
                                        std::size_t count) {
  const Lanes furthest = Lanes{} + start.furthest;
  for (std::size_t i = 0; i < count; i += kLanes) {
    std::array<Lanes, 3> along;
    __builtin_memcpy(&along, directions + 3 * i, sizeof along);
    WalkAxis x(start, 0, along[0]), y(start, 1, along[1]), z(start, 2, along[2]);
    LaneInts cell = LaneInts{} + start.cell, alive = LaneInts{} - 1;
    for (;;) {
      const std::uint8_t a = pass(bytes + cell[0]), b = pass(bytes + cell[1]), c = pass(bytes + cell[2]),
                         d = pass(bytes + cell[3]);
      if (((a | b | c | d) & kRock) != 0) alive &= (LaneInts{a, b, c, d} & kRock) == 0;
      // Without a branch: which border comes next cannot be predicted.
      const LaneInts y_before_z = y.next < z.next;
      const Lanes y_or_z = y_before_z ? y.next : z.next;
      const LaneInts x_first = x.next < y_or_z;
      alive &= (x_first ? x.next : y_or_z) <= furthest;
      if ((alive[0] | alive[1] | alive[2] | alive[3]) == 0) break;
      LaneInts steps{};
      x.cross(x_first, steps);
      y.cross(y_before_z & ~x_first, steps);
      z.cross(~(x_first | y_before_z), steps);
      cell += steps & alive;
    }
  }
}

// The same arithmetic with four lanes to an instruction where the processor has AVX2: no fused multiply-add,
// so the cells are the same.
[[gnu::target("avx2")]] void walk_by_avx2(std::uint8_t* bytes, const WalkStart& start,
                                          const double* directions, std::size_t count) {
  walk(bytes, start, directions, count);
}
void walk_by_sse(std::uint8_t* bytes, const WalkStart& start, const double* directions, std::size_t count) {
  walk(bytes, start, directions, count);
}

/// Tells whether a length is within limits, mostly without its root.
class Within {
 public:
  Within(double nearest, double furthest)
      : nearest_(nearest),
        furthest_(furthest),
        low2_(squared(nearest + kMargin)),
        high2_(squared(std::max(0.0, furthest - kMargin))) {}
  bool operator()(const Vec3& v) const {
    const double l2 = v.squaredNorm();
    if (l2 > low2_ && l2 < high2_) return true;
    const double length = v.norm();
    return length >= nearest_ && length <= furthest_;
  }

 private:
  static constexpr double kMargin = 1e-6;  // far more than the error of a root
  static double squared(double v) { return v * v; }
  double nearest_, furthest_, low2_, high2_;
};

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

/// The directions in the world, three vectors of lanes for each group of rays. The last group is filled up
/// with its last ray: a cell counts once.
void SensorRays::turn(const core::Quat& q) {
  const std::size_t groups = (directions_.size() + kLanes - 1) / kLanes;
  turned_.resize(3 * kLanes * groups);
  low_ = high_ = Vec3::Zero();
  for (std::size_t i = 0; i < groups * kLanes; ++i) {
    const Vec3 direction = q * directions_[std::min(i, directions_.size() - 1)];
    double* const group = turned_.data() + i / kLanes * 3 * kLanes + i % kLanes;
    for (std::size_t axis = 0; axis < 3; ++axis) group[axis * kLanes] = direction[static_cast<int>(axis)];
    low_ = low_.cwiseMin(direction);
    high_ = high_.cwiseMax(direction);
  }
}

std::uint64_t SensorRays::newly_seen(const core::VoxelMap& map, const karst_viewpoint_t& from) {
  const core::Pose T_world_sensor =
      core::Pose{to_core(from.position), core::from_heading(from.heading_rad)} * T_body_sensor_;
  const Vec3 eye = T_world_sensor.position / map.resolution_m();  // in cells, as all below
  const double nearest = min_range_m_ / map.resolution_m(), furthest = max_range_m_ / map.resolution_m();
  turn(T_world_sensor.orientation);
  const auto key_of = [](const Vec3& v) {
    const auto floor_of = [](double d) { return static_cast<std::int32_t>(std::floor(d)); };
    return CellKey{floor_of(v.x()), floor_of(v.y()), floor_of(v.z())};
  };
  const Vec3 beyond = Vec3::Constant(1.0);
  Window window(map, key_of(eye + furthest * low_ - beyond), key_of(eye + furthest * high_ + beyond), bytes_);
  const Vec3 floor = eye.array().floor();
  WalkStart start{.below = eye - floor, .above = floor + Vec3::Constant(1.0) - eye};
  start.cell = window.index_of(key_of(eye));
  for (int axis = 0; axis < 3; ++axis) start.stride[static_cast<std::size_t>(axis)] = window.stride(axis);
  start.furthest = furthest;
  static const auto walk_all = __builtin_cpu_supports("avx2") ? walk_by_avx2 : walk_by_sse;
  walk_all(window.bytes(), start, turned_.data(), turned_.size() / 3);
  std::uint64_t count = 0;
  const Within within(nearest, furthest);
  window.for_each_seen(
      [&](const CellKey& k) { count += within(Vec3(k.x + 0.5, k.y + 0.5, k.z + 0.5) - eye); });
  return count;
}

}  // namespace karst::host
