// How the map's frame lies in the world: where its start is, and where its y axis points.
#pragma once
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "core_stack/common/geometry.h"
#include "sdk/survey_export/flown_survey.h"

namespace karst::survey_export {

struct Placing {
  /// Of the place where the vehicle stood; none: that of the map, plus FlownSurvey::offset_m.
  std::optional<core::Vec3> start_m;
  /// Whether the files fix the entrance. Not, if the survey is to hang on stations of another one.
  bool fixed = true;
  /// As Survex and Therion both name it: "EPSG:32633", "UTM33N". Empty: local coordinates.
  std::string system;
  /// Added to the map's bearings: the angle, clockwise, from north to the map's y axis. With a coordinate
  /// system, north is that of its grid.
  double declination_deg = 0;
};

/// A position of the map in the survey's coordinates.
inline core::Vec3 placed(const Placing& placing, const FlownSurvey& flown, const core::Vec3& p) {
  const double turn_rad = -placing.declination_deg * std::numbers::pi / 180;  // counter-clockwise
  const core::Vec3 from_start = p - flown.start;
  return placing.start_m.value_or(flown.start + flown.offset_m) +
         Eigen::AngleAxisd(turn_rad, core::Vec3::UnitZ()) * from_start;
}

}  // namespace karst::survey_export
