#include "sdk/survey/therion_data.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core_stack/common/format_text.h"
#include "core_stack/common/printable.h"
#include "sdk/survey/therion_files.h"

namespace karst::survey {
namespace {

constexpr double kBacksight_deg = 5;  // readings there and back that differ by more are noted
constexpr double kBacksight = 0.05;   // the same of lengths, relative
constexpr double kBacksight_m = 0.2;  // but not below this

double both(double there, double back) {
  if (std::isnan(there)) return back;
  return std::isnan(back) ? there : (there + back) / 2;
}

/// In [0, 360), as readings off a compass are.
double turned(double degrees) {
  if (degrees < 0) degrees += 360;
  return degrees >= 360 ? degrees - 360 : degrees;
}

double difference_deg(double a, double b) {
  const double d = std::fmod(std::abs(a - b), 360);
  return std::min(d, 360 - d);
}

double mean_bearing(double a, double b) {
  constexpr double kRadians = std::numbers::pi / 180;
  const double east = std::sin(a * kRadians) + std::sin(b * kRadians);
  const double north = std::cos(a * kRadians) + std::cos(b * kRadians);
  return turned(std::atan2(east, north) / kRadians);
}

}  // namespace

void DataRows::refuse(const std::string& reason) const { throw readings_.log.error(source_, reason); }

void DataRows::begin(const DataFormat& format) {
  interrupt();
  format_ = format;
}

void DataRows::interrupt() {
  if (at_ > 0 && !format_.interleaved())
    throw readings_.log.error(row_.source, "not enough readings: the lines of this row end early");
  if (before_ && format_.has(Column::newline))
    readings_.log.note(before_->source, "readings behind a station that no other station follows: left out");
  at_ = 0;
  before_.reset();
  last_to_.reset();
}

void DataRows::row(const std::vector<std::string>& words, const Source& source, std::uint32_t survey,
                   const Settings& settings) {
  source_ = source;
  survey_ = survey;
  settings_ = &settings;
  if (at_ == 0) {
    row_ = Row{};
    row_.value.fill(kNotRead);
    row_.source = source;
  }
  std::size_t next = 0;
  bool line_ends = false;
  while (at_ < format_.order.size() && !line_ends) {
    const Column column = format_.order[at_++];
    line_ends = column == Column::newline;
    if (line_ends) continue;
    if (column == Column::ignore_all) {
      next = words.size();
      break;
    }
    if (next == words.size()) refuse("not enough readings");
    take(column, words[next++], row_);
  }
  if (next < words.size())
    refuse("more readings than columns, from '" + core::printable(words[next]) + "' on");
  const bool ends = at_ >= format_.order.size();
  const bool first_line = line_ends || !format_.has(Column::newline);
  if (format_.interleaved() && first_line) end_of_station_row();
  if (!ends) return;
  at_ = 0;
  end_of_row();
}

std::uint32_t DataRows::station_of(const std::string& word, bool defines) {
  if (word == "." || word == "-") return names_.anonymous(source_);
  const auto name = settings_->station_name(word);
  if (!name) refuse("is no name of a station: " + core::printable(word));
  return names_.number(survey_, *name, source_, defines);
}

void DataRows::take(Column column, const std::string& word, Row& row) {
  const bool defines = !format_.dimensions;
  switch (column) {
    case Column::station:
      row.station = station_of(word, defines);
      return;
    case Column::from:
      row.from = station_of(word, defines);
      return;
    case Column::to:
      row.to = station_of(word, defines);
      return;
    case Column::direction:
      if (word != "f" && word != "F" && word != "b" && word != "B")
        refuse("a direction is f or b, not " + core::printable(word));
      row.backwards = word == "b" || word == "B";
      return;
    case Column::up:
    case Column::down:
    case Column::left:
    case Column::right:
      take_dimension(column, word, row);
      return;
    case Column::ignore:
      return;
    default:
      break;
  }
  const bool angle = column == Column::bearing || column == Column::back_bearing ||
                     column == Column::gradient || column == Column::back_gradient;
  const bool slope = column == Column::gradient || column == Column::back_gradient;
  const auto number = angle ? degrees_of(word) : number_of(word);
  if (!number) refuse("is no number: '" + core::printable(word) + "'");
  // A compass need not be read on plumbed legs, and there and back need not both be read.
  if (std::isnan(*number) && !angle && column != Column::length && column != Column::back_length)
    refuse("is no reading: '" + core::printable(word) + "'");
  if (std::isinf(*number) && !slope) refuse("is no reading: '" + core::printable(word) + "'");
  row.value[static_cast<std::size_t>(column)] = *number;
}

void DataRows::take_dimension(Column column, const std::string& word, Row& row) {
  const Quantity quantity = column == Column::up     ? Quantity::up
                            : column == Column::down ? Quantity::down
                            : column == Column::left ? Quantity::left
                                                     : Quantity::right;
  const auto value = [&](const std::string& text) -> std::optional<double> {
    const auto number = number_of(text);
    if (!number || std::isinf(*number)) refuse("is no distance to a wall: '" + core::printable(text) + "'");
    if (std::isnan(*number)) return std::nullopt;
    const double metres = settings_->metres(quantity, *number);
    if (metres < 0) refuse("is a negative distance to a wall: " + core::printable(text));
    return metres;
  };
  std::vector<std::string> parts;
  split_words(word, parts);  // [AT_FROM AT_TO]
  if (parts.empty() || parts.size() > (format_.has(Column::from) ? 2u : 1u))
    refuse("is no distance to a wall: '" + core::printable(word) + "'");
  const auto set = [&](Dimensions& d, std::optional<double> metres) {
    (quantity == Quantity::up     ? d.up_m
     : quantity == Quantity::down ? d.down_m
     : quantity == Quantity::left ? d.left_m
                                  : d.right_m) = metres;
  };
  set(row.dimensions[1], value(parts.back()));
  if (parts.size() == 2) set(row.dimensions[0], value(parts.front()));
}

void DataRows::end_of_station_row() {
  if (before_) {
    Row row = *before_;
    row.dimensions = {before_->dimensions[1], row_.dimensions[1]};
    row.of_stations = true;
    const auto keep = [&](Column column, Column first, Column second) {
      row.value[static_cast<std::size_t>(first)] = before_->value[static_cast<std::size_t>(column)];
      row.value[static_cast<std::size_t>(second)] = row_.value[static_cast<std::size_t>(column)];
    };
    if (format_.has(Column::count)) keep(Column::count, Column::from_count, Column::to_count);
    if (format_.has(Column::depth)) keep(Column::depth, Column::from_depth, Column::to_depth);
    leg(row, before_->station, row_.station);
    before_.reset();
  }
}

void DataRows::end_of_row() {
  if (format_.dimensions) {
    if (names_.is_anonymous(row_.station)) refuse("dimensions belong to a station with a name");
    if (row_.dimensions[1].any())
      readings_.station_dimensions.push_back({row_.station, row_.dimensions[1], source_});
  } else if (format_.interleaved()) {
    before_ = row_;
  } else {
    leg(row_, row_.from, row_.to);
  }
}

void DataRows::leg(const Row& row, std::uint32_t from, std::uint32_t to) {
  if (names_.is_anonymous(from) && names_.is_anonymous(to)) refuse("a leg has a station with a name");
  if (from == to) refuse("a leg from a station to itself");
  Reading reading = reading_of(row);
  reading.from = from;
  reading.to = to;
  reading.splay = settings_->splay || names_.is_anonymous(from) || names_.is_anonymous(to);
  const bool level = settings_->infer_equates && reading.style != Style::no_survey &&
                     reading.vector_m().norm() == 0 && !reading.splay;
  if (level) {
    readings_.equates.push_back({from, to, source_});
    if (row.dimensions[1].any()) readings_.station_dimensions.push_back({to, row.dimensions[1], row.source});
    if (last_to_ == from) last_to_ = to;  // the run goes on
    return;
  }
  add(std::move(reading), row);
}

std::uint32_t DataRows::conditions_now() {
  if (!conditions_fresh_ || readings_.conditions.back() != settings_->conditions)
    readings_.conditions.push_back(settings_->conditions);
  conditions_fresh_ = true;
  return static_cast<std::uint32_t>(readings_.conditions.size() - 1);
}

void DataRows::add(Reading reading, const Row& row) {
  if (readings_.legs.size() >= kMaxReadings)
    refuse("more than " + std::to_string(kMaxReadings) + " legs are not read");
  reading.conditions = conditions_now();
  if (!reading.splay && (!last_to_ || *last_to_ != reading.from)) ++run_;
  if (!reading.splay) last_to_ = reading.to;
  reading.run = run_;
  readings_.legs.push_back(reading);
  if (!reading.splay) add_dimensions(row);
}

void DataRows::add_dimensions(const Row& row) {
  const auto leg = static_cast<std::uint32_t>(readings_.legs.size() - 1);
  for (const bool at_end : {false, true})
    if (const Dimensions& d = row.dimensions[at_end ? 1 : 0]; d.any())
      readings_.dimensions.push_back({leg, at_end, d, row.source});
}

Reading DataRows::reading_of(const Row& row) const {
  Reading reading;
  reading.source = row.source;
  reading.style = format_.style;
  reading.surface = settings_->surface;
  reading.duplicate = settings_->duplicate;
  reading.approximate = settings_->approximate;
  reading.extend = settings_->extend;
  if (reading.style == Style::no_survey) return reading;
  if (reading.style == Style::cartesian) {
    const auto part = [&](Column column, Quantity quantity) {
      const double value = row.value[static_cast<std::size_t>(column)];
      const double metres = std::isnan(value) ? 0 : settings_->metres(quantity, value);
      return row.backwards ? -metres : metres;
    };
    reading.east_m = part(Column::easting, Quantity::easting);
    reading.north_m = part(Column::northing, Quantity::northing);
    reading.rise_m = part(Column::altitude, Quantity::altitude);
    return reading;
  }
  set_length(row, reading);
  if (reading.style == Style::normal || reading.style == Style::topofil)
    set_inclination(row, reading);
  else
    set_rise(row, reading);
  set_bearing(row, reading);
  return reading;
}

double DataRows::change_m(const Row& row, Quantity quantity, Column first, Column second) const {
  const double a = row.value[static_cast<std::size_t>(first)],
               b = row.value[static_cast<std::size_t>(second)];
  if (row.of_stations) return settings_->metres(quantity, b) - settings_->metres(quantity, a);
  return settings_->metres_between(quantity, a, b);
}

void DataRows::set_length(const Row& row, Reading& reading) const {
  const auto value = [&](Column c) { return row.value[static_cast<std::size_t>(c)]; };
  if (!std::isnan(value(Column::from_count))) {
    reading.length_m = change_m(row, Quantity::counter, Column::from_count, Column::to_count);
    if (reading.style == Style::normal) reading.style = Style::topofil;
    if (reading.length_m < 0) refuse("the counter runs backwards");
    return;
  }
  const auto metres = [&](Column c) {
    return std::isnan(value(c)) ? kNotRead : settings_->metres(Quantity::length, value(c));
  };
  const double there = metres(Column::length), back = metres(Column::back_length);
  reading.length_m = both(there, back);
  if (std::isnan(reading.length_m)) refuse("the length is missing");
  if (reading.length_m < 0) refuse("a negative length");
  if (std::abs(there - back) > std::max(kBacksight_m, kBacksight * reading.length_m))
    readings_.log.note(source_, core::format_text("lengths there and back differ by %.2f m; averaged",
                                                  std::abs(there - back)));
}

void DataRows::set_bearing(const Row& row, Reading& reading) const {
  const auto degrees = [&](Column c) {
    const double value = row.value[static_cast<std::size_t>(c)];
    if (std::isnan(value)) return kNotRead;
    const double bearing = turned(settings_->degrees(Quantity::bearing, value));
    if (bearing < 0 || bearing >= 360) refuse(core::format_text("a bearing out of range: %g", value));
    constexpr double kRounding_deg = 1e-6;  // 400 grads are 360 degrees
    if (const double read = settings_->bearing.degrees(value);
        read < -kRounding_deg || read > 360 + kRounding_deg)
      readings_.log.note(source_,
                         core::format_text("a bearing out of range, %g: taken as %g deg", value, bearing));
    return bearing;
  };
  const double there = degrees(Column::bearing);
  const double back = turned(degrees(Column::back_bearing) - 180);
  if (std::isnan(there) || std::isnan(back)) {
    reading.bearing_deg = std::isnan(there) ? back : there;
  } else {
    reading.bearing_deg = mean_bearing(there, back);
    if (const double off = difference_deg(there, back); off > kBacksight_deg && !reading.plumbed)
      readings_.log.note(source_,
                         core::format_text("bearings there and back differ by %.1f deg; averaged", off));
  }
  if (row.backwards) reading.bearing_deg = turned(reading.bearing_deg + 180);
  if (!std::isnan(reading.bearing_deg)) return;
  const core::Vec3 vector = reading.vector_m();
  if (vector.head<2>().norm() > 1e-6 * (vector.norm() + 1e-9))
    refuse("the bearing is missing, and the leg is not vertical");
  reading.plumbed = true;
}

void DataRows::set_inclination(const Row& row, Reading& reading) const {
  const auto degrees = [&](Column c) {
    const double value = row.value[static_cast<std::size_t>(c)];
    if (std::isnan(value)) return kNotRead;
    if (std::isinf(value)) return value > 0 ? kUp : -kUp;
    double slope = settings_->degrees(Quantity::gradient, value);
    if (slope >= 269.99999 && slope <= 360.00001) slope -= 360;
    if (std::abs(slope) > 90.00001) refuse(core::format_text("an inclination out of range: %g", value));
    return std::clamp(slope, -90.0, 90.0);
  };
  const double there = degrees(Column::gradient), back = -degrees(Column::back_gradient);
  if (std::isnan(there) && std::isnan(back)) refuse("the inclination is missing");
  if (!std::isnan(there) && !std::isnan(back) && (std::isinf(there) || std::isinf(back)) && there != back)
    refuse("a leg is plumbed one way only");
  double slope = std::isinf(there) ? there : both(there, back);
  if (std::abs(there - back) > kBacksight_deg && std::isfinite(slope))
    readings_.log.note(source_, core::format_text("inclinations there and back differ by %.1f deg; averaged",
                                                  std::abs(there - back)));
  reading.plumbed = std::isinf(slope) || (settings_->infer_plumbs && std::abs(slope) == 90);
  if (std::isinf(slope)) slope = slope > 0 ? 90 : -90;
  reading.inclination_deg = row.backwards ? -slope : slope;
}

void DataRows::set_rise(const Row& row, Reading& reading) const {
  const auto value = [&](Column c) { return row.value[static_cast<std::size_t>(c)]; };
  double rise = 0;
  if (!std::isnan(value(Column::depth_change)))
    rise = settings_->metres(Quantity::depth, value(Column::depth_change));
  else
    rise = change_m(row, Quantity::depth, Column::from_depth, Column::to_depth);
  reading.rise_m = row.backwards ? -rise : rise;
  if (reading.style == Style::diving && std::abs(rise) > reading.length_m + 1e-9)
    readings_.log.note(source_, "the depth changes by more than the length of the tape; taken as vertical");
}

}  // namespace karst::survey
