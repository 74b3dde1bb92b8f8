// The words of Therion's `data`, `units`, `calibrate` and `sd`.
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace karst::survey {

/// A column of `data`.
enum class Column {
  station,
  from,
  to,
  direction,
  length,
  back_length,
  bearing,
  back_bearing,
  gradient,
  back_gradient,
  count,
  from_count,
  to_count,
  depth,
  from_depth,
  to_depth,
  depth_change,
  northing,
  easting,
  altitude,
  up,
  down,
  left,
  right,
  newline,
  ignore,
  ignore_all
};
constexpr std::size_t kColumns = static_cast<std::size_t>(Column::ignore_all) + 1;
std::optional<Column> column_of(std::string_view word);

/// What has a unit, a calibration and a standard deviation of its own.
enum class Quantity {
  length,
  counter,
  depth,
  x,
  y,
  z,
  easting,
  northing,
  altitude,
  up,
  down,
  left,
  right,
  bearing,
  gradient
};
constexpr std::size_t kQuantities = static_cast<std::size_t>(Quantity::gradient) + 1;
constexpr bool is_angle(Quantity q) { return q == Quantity::bearing || q == Quantity::gradient; }
/// Those that a word means, such as x, y and z for `position`; none if it means none.
std::vector<Quantity> quantities_of(std::string_view word);

/// Commands of a centreline that say nothing of its shape.
bool is_remark(std::string_view command);

}  // namespace karst::survey
