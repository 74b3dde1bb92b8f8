// What the commands of a centreline set for the readings that follow.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "sdk/survey/readings.h"
#include "sdk/survey/therion_units.h"
#include "sdk/survey/therion_words.h"

namespace karst::survey {

struct Settings {
  std::array<LengthScale, kQuantities> lengths;  // of quantities that are lengths
  AngleScale bearing, gradient;
  std::array<Calibration, kQuantities> calibrations;
  Conditions conditions;
  std::string system;  // of coordinates
  std::string name_prefix, name_suffix;
  Extend extend = Extend::normal;
  bool surface = false, duplicate = false, approximate = false, splay = false;
  bool infer_plumbs = false, infer_equates = false;

  const Calibration& calibration(Quantity q) const { return calibrations[static_cast<std::size_t>(q)]; }
  /// Of a reading, calibrated. A quantity is a length, or bearing or gradient.
  double metres(Quantity q, double reading) const {
    return lengths[static_cast<std::size_t>(q)].metres(calibration(q).corrected(reading));
  }
  double degrees(Quantity q, double reading) const {
    return (q == Quantity::bearing ? bearing : gradient).degrees(calibration(q).corrected(reading));
  }
  /// A station's name as `station-names` completes it: "p1x@branch" of "1@branch". None if it is no name.
  std::optional<std::string> station_name(const std::string& word) const;
  /// Of the difference of two readings: a zero error cancels in it, and is then applied once, as in Therion.
  double metres_between(Quantity q, double first, double second) const;
};

/// Each carries out the command whose words these are. Returns why it cannot, or nothing.
using Refusal = std::optional<std::string>;
Refusal set_units(const std::vector<std::string>& words, Settings& settings);
Refusal set_calibration(const std::vector<std::string>& words, Settings& settings);
Refusal set_deviation(const std::vector<std::string>& words, Settings& settings);
Refusal set_flags(const std::vector<std::string>& words, Settings& settings);
Refusal set_infer(const std::vector<std::string>& words, Settings& settings);

/// Declinations by year, as a survey or a centreline gives them.
struct Declinations {
  Calibration by_year;            // degrees
  std::optional<double> undated;  // degrees
  bool any() const { return undated.has_value() || !by_year.table.empty(); }
  /// For readings without a date: the undated one, else that of the middle of the years.
  double at(const std::optional<YearRange>& years) const;
};
/// Of "VALUE UNIT", or "DATE VALUE DATE VALUE ... UNIT" with "-" for the date of undated readings; of "-",
/// none.
Refusal read_declinations(const std::vector<std::string>& words, Declinations& declinations);

}  // namespace karst::survey
