#include "sdk/survey/therion_units.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "sdk/survey/lower_case.h"

namespace karst::survey {
namespace {

constexpr double kFoot_m = 0.3048;

struct UnitOfLength {
  std::string_view name;
  double metres;
};
constexpr auto kLengths = std::to_array<UnitOfLength>({
    {"m", 1},
    {"metre", 1},
    {"metres", 1},
    {"meter", 1},
    {"meters", 1},
    {"metric", 1},
    {"cm", 0.01},
    {"centimetre", 0.01},
    {"centimetres", 0.01},
    {"centimeter", 0.01},
    {"centimeters", 0.01},
    {"mm", 0.001},
    {"millimetre", 0.001},
    {"millimetres", 0.001},
    {"millimeter", 0.001},
    {"millimeters", 0.001},
    {"ft", kFoot_m},
    {"feet", kFoot_m},
    {"feets", kFoot_m},
    {"in", kFoot_m / 12},
    {"inch", kFoot_m / 12},
    {"inches", kFoot_m / 12},
    {"yd", 3 * kFoot_m},
    {"yard", 3 * kFoot_m},
    {"yards", 3 * kFoot_m},
});

struct NamedAngle {
  std::string_view name;
  AngleUnit unit;
};
// A mil is the artillery's: 6400 make a turn.
constexpr auto kAngles = std::to_array<NamedAngle>({
    {"deg", {1, false}},
    {"degree", {1, false}},
    {"degrees", {1, false}},
    {"grad", {0.9, false}},
    {"grads", {0.9, false}},
    {"mil", {360.0 / 6400, false}},
    {"mils", {360.0 / 6400, false}},
    {"min", {1.0 / 60, false}},
    {"minute", {1.0 / 60, false}},
    {"minutes", {1.0 / 60, false}},
    {"percent", {1, true}},
    {"percentage", {1, true}},
});

std::optional<double> plain_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, failed] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (failed != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<int> digits(std::string_view word) {
  int value = 0;
  const auto [end, failed] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (failed != std::errc() || end != word.data() + word.size() || value < 0) return std::nullopt;
  return value;
}

/// The part of `text` before `separator`, which is removed from it.
std::string_view take(std::string_view& text, char separator) {
  const std::size_t end = std::min(text.find(separator), text.size());
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return part;
}

std::optional<YearRange> years_of_day(std::string_view word) {
  word = word.substr(0, word.find('@'));
  const auto year = digits(take(word, '.'));
  if (!year || *year > 9999) return std::nullopt;
  if (word.empty()) return YearRange{*year + 0.0, *year + 1.0};
  const auto month = digits(take(word, '.'));
  if (!month || *month < 1 || *month > 12) return std::nullopt;
  if (word.empty()) return YearRange{*year + (*month - 1) / 12.0, *year + *month / 12.0};
  const auto day = digits(word);
  if (!day || *day < 1 || *day > 31) return std::nullopt;
  constexpr std::array kDaysBefore = {0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334};
  const double at = *year + (kDaysBefore.at(static_cast<std::size_t>(*month - 1)) + *day - 1) / 365.25;
  return YearRange{at, at};
}

}  // namespace

std::optional<double> number_of(std::string_view word) {
  if (const auto number = plain_number(word)) return number;
  const std::string name = lower_case(word);
  if (name == "-" || name == "." || name == "nan") return std::numeric_limits<double>::quiet_NaN();
  if (name == "up" || name == "inf" || name == "+inf") return kUp;
  if (name == "down" || name == "-inf") return -kUp;
  return std::nullopt;
}

std::optional<double> degrees_of(std::string_view word) {
  if (word.find(':') == std::string_view::npos) return number_of(word);
  const bool negative = word.starts_with('-');
  if (negative || word.starts_with('+')) word.remove_prefix(1);
  double value = 0, part_degrees = 1;
  for (int parts = 0; !word.empty(); ++parts, part_degrees /= 60) {
    const auto number = plain_number(take(word, ':'));
    if (parts == 3 || !number || *number < 0) return std::nullopt;
    value += *number * part_degrees;
  }
  return negative ? -value : value;
}

std::optional<double> metres_of_unit(std::string_view unit) {
  for (const UnitOfLength& u : kLengths)
    if (u.name == unit) return u.metres;
  return std::nullopt;
}

std::optional<AngleUnit> angle_unit(std::string_view unit) {
  for (const NamedAngle& a : kAngles)
    if (a.name == unit) return a.unit;
  return std::nullopt;
}

double AngleScale::degrees(double value) const {
  value *= factor;
  return unit.percent ? std::atan(value / 100) * 180 / std::numbers::pi : value * unit.degrees;
}

double Calibration::corrected(double value) const {
  if (table.empty()) return (value - zero) * scale;
  const auto above = std::lower_bound(table.begin(), table.end(), value,
                                      [](const auto& row, double v) { return row.first < v; });
  if (above == table.begin()) return table.front().second;
  if (above == table.end()) return table.back().second;
  const auto [x1, y1] = *(above - 1);
  const auto [x2, y2] = *above;
  return x1 == x2 ? y1 : y1 + (value - x1) * (y2 - y1) / (x2 - x1);
}

CalibrationWords calibration_of(const std::vector<std::string>& words, std::size_t first) {
  CalibrationWords read;
  std::vector<double> numbers;
  for (std::size_t i = first; i < words.size(); ++i) {
    const auto number = number_of(words[i]);
    if (!number || !std::isfinite(*number)) return {{}, "is no number of a calibration: " + words[i]};
    numbers.push_back(*number);
  }
  if (numbers.empty() || (numbers.size() > 2 && numbers.size() % 2 != 0))
    return {{}, "a calibration is a zero error, with a scale if need be, or pairs of numbers"};
  if (numbers.size() <= 2) {
    read.calibration.zero = numbers[0];
    if (numbers.size() == 2) read.calibration.scale = numbers[1];
    if (read.calibration.scale == 0) return {{}, "the scale of a calibration cannot be zero"};
    return read;
  }
  for (std::size_t i = 0; i < numbers.size(); i += 2)
    read.calibration.table.emplace_back(numbers[i], numbers[i + 1]);
  std::sort(read.calibration.table.begin(), read.calibration.table.end());
  return read;
}

std::optional<YearRange> years_of(const std::vector<std::string>& words, std::size_t first) {
  std::string text;
  for (std::size_t i = first; i < words.size(); ++i) text += words[i];
  std::string_view rest = text;
  const auto begin = years_of_day(take(rest, '-'));
  if (!begin) return std::nullopt;
  if (rest.empty()) return begin;
  const auto end = years_of_day(rest);
  if (!end || end->end < begin->begin) return std::nullopt;
  return YearRange{begin->begin, end->end};
}

}  // namespace karst::survey
