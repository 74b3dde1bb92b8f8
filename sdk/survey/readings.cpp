#include "sdk/survey/readings.h"

#include <cmath>
#include <numbers>

namespace karst::survey {

core::Vec3 Reading::vector_m() const {
  constexpr double kRadians = std::numbers::pi / 180;
  const double bearing = plumbed || std::isnan(bearing_deg) ? 0 : bearing_deg * kRadians;
  const auto along = [&](double level_m, double up_m) {
    return core::Vec3(level_m * std::sin(bearing), level_m * std::cos(bearing), up_m);
  };
  switch (style) {
    case Style::normal:
    case Style::topofil: {
      const double slope = inclination_deg * kRadians;
      return along(plumbed ? 0 : length_m * std::cos(slope), length_m * std::sin(slope));
    }
    case Style::diving:
      return along(std::sqrt(std::max(0.0, length_m * length_m - rise_m * rise_m)), rise_m);
    case Style::cylpolar:
      return along(length_m, rise_m);
    case Style::cartesian:
      return {east_m, north_m, rise_m};
    case Style::no_survey:
      break;
  }
  return core::Vec3::Zero();
}

}  // namespace karst::survey
