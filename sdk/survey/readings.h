// A survey as it was read, before its loops are closed.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/common/geometry.h"
#include "sdk/survey/source_log.h"
#include "sdk/survey/survey.h"
#include "sdk/survey/therion_units.h"

namespace karst::survey {

constexpr double kNotRead = std::numeric_limits<double>::quiet_NaN();

/// What holds for many legs: how compass north lies, and standard deviations.
struct Conditions {
  std::optional<double> declination_deg;
  bool declination_from_grid = false;  // counted from grid north of the coordinate system
  std::optional<YearRange> years;      // of the measurement
  /// Standard deviations, where given: metres and degrees.
  std::optional<double> tape_m, compass_deg, clino_deg, depth_m, east_m, north_m, up_m;

  bool operator==(const Conditions&) const = default;
};

/// Calibrated and averaged with its backsight. Which values hold depends on the style:
/// normal, topofil: tape, bearing, inclination; diving: tape along the slope, bearing, rise; cylpolar: tape
/// on the level, bearing, rise; cartesian: east, north, rise.
struct Reading {
  std::uint32_t from = 0, to = 0;  // of Readings::stations
  std::uint32_t conditions = 0;    // of Readings::conditions
  std::uint32_t run = 0;
  Source source;
  Style style = Style::normal;
  bool surface = false, duplicate = false, approximate = false, splay = false;
  Extend extend = Extend::normal;
  bool plumbed = false;  // straight up or down: no compass
  double length_m = kNotRead;
  double bearing_deg = kNotRead;  // magnetic, until the declination is added
  double inclination_deg = kNotRead;
  double east_m = kNotRead, north_m = kNotRead, rise_m = kNotRead;

  /// East, north, up. Zero for legs that were not measured.
  core::Vec3 vector_m() const;
};

struct Fix {
  std::uint32_t station = 0;
  std::string system;  // Therion's name of the coordinate system; empty: local
  /// Metres; of geographic systems degrees, in the order in which the system's name has them.
  double x = 0, y = 0, z = 0;
  std::optional<core::Vec3> sd_m;
  Source source;
};

struct Equate {
  std::uint32_t a = 0, b = 0;
  Source source;
};

struct ReadDimensions {
  std::uint32_t leg = 0;
  bool at_end = false;  // of the leg: at its second station
  Dimensions dimensions;
  Source source;
};
/// Noted for a station, not with a leg (`data dimensions`).
struct StationDimensions {
  std::uint32_t station = 0;
  Dimensions dimensions;
  Source source;
};

struct ReadStation {
  std::string name;  // in full
  std::string comment;
  bool entrance = false, continuation = false;
  bool anonymous = false;  // the far end of a splay
  Source source;
};

struct Readings {
  std::string title;
  std::vector<ReadStation> stations;
  std::vector<Reading> legs;
  std::vector<Conditions> conditions;
  std::vector<Equate> equates;
  std::vector<Fix> fixes;
  std::vector<ReadDimensions> dimensions;  // in the order of the legs
  std::vector<StationDimensions> station_dimensions;
  SourceLog log;
};

constexpr std::size_t kMaxReadings = 10'000'000;  // legs

}  // namespace karst::survey
