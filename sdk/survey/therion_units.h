// Numbers, units and calibrations of Therion. Lengths are converted to metres, angles to degrees.
#pragma once
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace karst::survey {

constexpr double kUp = std::numeric_limits<double>::infinity();

/// A number of Therion: nan for "-" and ".", +-kUp for "up" and "down"; none for what is no number.
std::optional<double> number_of(std::string_view word);
/// The same, or degrees:minutes:seconds.
std::optional<double> degrees_of(std::string_view word);

/// Metres that the unit has; none if there is no such unit of length.
std::optional<double> metres_of_unit(std::string_view unit);

struct AngleUnit {
  double degrees = 1;    // that the unit has
  bool percent = false;  // a slope instead: 100 is 45 degrees
};
std::optional<AngleUnit> angle_unit(std::string_view unit);

/// The unit of a quantity, and a factor on top: `units length 2 feet`.
struct LengthScale {
  double unit_m = 1, factor = 1;
  double metres(double value) const { return value * factor * unit_m; }
};
struct AngleScale {
  AngleUnit unit;
  double factor = 1;
  double degrees(double value) const;
};

/// Corrects a reading before its unit is applied: (value - zero) * scale, or a table of readings and true
/// values, interpolated linearly and constant beyond its ends.
struct Calibration {
  double zero = 0, scale = 1;
  std::vector<std::pair<double, double>> table;  // ascending
  double corrected(double value) const;
};
/// Of `calibrate ... ZERO [SCALE]` or of pairs of numbers. An error is a reason in words.
struct CalibrationWords {
  Calibration calibration;
  std::string error;
};
CalibrationWords calibration_of(const std::vector<std::string>& words, std::size_t first);

/// Of a day, or of the middle of an interval: as a year with a fraction. Forms: 1975, 1975.08, 1975.08.08,
/// each with a time behind '@', and two of them with "-" between. None for what is no date.
struct YearRange {
  double begin = 0, end = 0;
  double middle() const { return (begin + end) / 2; }
  bool operator==(const YearRange&) const = default;
};
std::optional<YearRange> years_of(const std::vector<std::string>& words, std::size_t first);

}  // namespace karst::survey
