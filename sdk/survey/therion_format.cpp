#include <algorithm>

#include "core_stack/common/printable.h"
#include "sdk/survey/therion_data.h"

namespace karst::survey {
namespace {

constexpr std::size_t kMaxColumns = 64;

std::optional<Style> style_of(const std::string& word) {
  if (word == "normal") return Style::normal;
  if (word == "topofil") return Style::topofil;
  if (word == "diving") return Style::diving;
  if (word == "cylpolar") return Style::cylpolar;
  if (word == "cartesian") return Style::cartesian;
  if (word == "nosurvey") return Style::no_survey;
  return std::nullopt;
}

bool belongs(Column column, Style style, bool dimensions) {
  using enum Column;
  const bool by_tape =
      style == Style::normal || style == Style::topofil || style == Style::diving || style == Style::cylpolar;
  switch (column) {
    case from:
    case to:
    case direction:
    case newline:
      return !dimensions;
    case length:
    case back_length:
    case bearing:
    case back_bearing:
    case count:
    case from_count:
    case to_count:
      return !dimensions && by_tape;
    case gradient:
    case back_gradient:
      return !dimensions && (style == Style::normal || style == Style::topofil);
    case depth:
    case from_depth:
    case to_depth:
    case depth_change:
      return !dimensions && (style == Style::diving || style == Style::cylpolar);
    case northing:
    case easting:
    case altitude:
      return !dimensions && style == Style::cartesian;
    default:
      return true;
  }
}

bool is_complete(const DataFormat& f) {
  using enum Column;
  if (f.dimensions) return f.has(station) && (f.has(up) || f.has(down) || f.has(left) || f.has(right));
  if (!f.has(station) && !(f.has(from) && f.has(to))) return false;
  const bool tape =
      f.has(length) || f.has(back_length) || f.has(count) || (f.has(from_count) && f.has(to_count));
  const bool compass = f.has(bearing) || f.has(back_bearing);
  switch (f.style) {
    case Style::normal:
    case Style::topofil:
      return tape && compass && (f.has(gradient) || f.has(back_gradient));
    case Style::diving:
    case Style::cylpolar:
      return tape && compass &&
             (f.has(depth) || f.has(depth_change) || (f.has(from_depth) && f.has(to_depth)));
    case Style::cartesian:
      return f.has(easting) || f.has(northing) || f.has(altitude);
    case Style::no_survey:
      return true;
  }
  return false;
}

/// Between the stations of interleaved data stand the readings of a leg, each on a line of its own.
Refusal check_interleaved(const DataFormat& f) {
  using enum Column;
  const bool of_stations = f.has(station) || f.has(count) || f.has(depth);
  if (!of_stations || f.dimensions) return std::nullopt;
  if (!f.has(station) || f.has(from) || f.has(to)) return "mixes readings of stations and of legs";
  const auto line_end = std::find(f.order.begin(), f.order.end(), newline);
  for (auto it = f.order.begin(); it != f.order.end(); ++it) {
    const bool of_station = *it == station || *it == count || *it == depth || *it == up || *it == down ||
                            *it == left || *it == right;
    if (*it == newline || *it == ignore || *it == ignore_all) continue;
    if (of_station != (it < line_end))
      return "readings of stations stand before newline, those of legs behind it";
  }
  return std::nullopt;
}

}  // namespace

bool DataFormat::has(Column column) const {
  return std::find(order.begin(), order.end(), column) != order.end();
}

Refusal read_format(const std::vector<std::string>& words, DataFormat& format) {
  format = {};
  format.order.clear();
  if (words.size() < 2) return "data lacks a style";
  if (words.size() > kMaxColumns) return "data has too many columns";
  format.dimensions = words[1] == "dimensions";
  const auto style = style_of(words[1]);
  if (!style && !format.dimensions) return "is no style of data: '" + core::printable(words[1]) + "'";
  format.style = style.value_or(Style::normal);
  for (std::size_t i = 2; i < words.size(); ++i) {
    const auto column = column_of(words[i]);
    const std::string shown = "'" + core::printable(words[i]) + "'";
    if (!column) return "is no reading: " + shown;
    if (!belongs(*column, format.style, format.dimensions)) return "is no reading of this style: " + shown;
    if (*column != Column::ignore && format.has(*column)) return "stands twice: " + shown;
    if (*column == Column::newline && (i == 2 || i + 1 == words.size()))
      return "newline stands between readings";
    format.order.push_back(*column);
    if (*column == Column::ignore_all) break;
  }
  if (!is_complete(format)) return "not all readings that this style needs";
  if (format.has(Column::length) && (format.has(Column::count) || format.has(Column::from_count)))
    return "a length stands beside counters";
  return check_interleaved(format);
}

}  // namespace karst::survey
