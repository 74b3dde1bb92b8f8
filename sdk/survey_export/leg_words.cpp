#include "sdk/survey_export/leg_words.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core_stack/common/format_text.h"
#include "core_stack/common/printable.h"

namespace karst::survey_export {
namespace {

using core::format_text;

constexpr double kDegrees = 180 / std::numbers::pi;

std::string distance_word(const std::optional<double>& distance_m) {
  return distance_m ? format_text(" %.2f", *distance_m) : " -";
}

}  // namespace

std::string station_word(const FlownSurvey& flown, std::uint32_t station) {
  return flown.survey.stations[station].name.substr(flown.name.size() + 1);
}

std::string leg_words(const FlownSurvey& flown, const survey::Leg& leg) {
  std::string text = station_word(flown, leg.from) + ' ' + station_word(flown, leg.to) +
                     format_text(" %.4f", leg.length_m.value_or(0));
  const double inclination_deg = leg.inclination_rad.value_or(0) * kDegrees;
  if (!leg.bearing_rad) return text + (inclination_deg < 0 ? " - down" : " - up");
  double bearing_deg = *leg.bearing_rad * kDegrees;
  if (bearing_deg > 359.99995) bearing_deg = 0;  // would print as 360
  return text + format_text(" %.4f %.4f", bearing_deg, inclination_deg);
}

std::string section_words(const FlownSurvey& flown, const survey::Section& section) {
  const survey::Dimensions& d = section.dimensions;
  return station_word(flown, section.station) + distance_word(d.left_m) + distance_word(d.right_m) +
         distance_word(d.up_m) + distance_word(d.down_m);
}

LegDeviations deviations_of(const FlownSurvey& flown, std::size_t leg) {
  const double sd_m = std::max(0.01, std::ceil(100 * flown.leg_sd_m[leg]) / 100);
  const double length_m = std::max(0.1, flown.survey.legs[leg].length_m.value_or(0));
  const double angle_deg = std::atan2(sd_m, length_m) * kDegrees;
  return {sd_m, std::max(0.1, std::ceil(10 * angle_deg) / 10)};
}

std::string accuracy_words(const Accuracy& a) {
  std::string text = format_text("standard deviation of a leg in each axis: %.3f m for the cells of its ends",
                                 a.leg_sd_m(0));
  if (a.scans == 0) return text + "; the run holds no record of its drift";
  return text +
         format_text(", and %.4f m times the root of its length in m for the drift (%zu scans in %.0f m)",
                     std::sqrt(a.growth_m2_per_m), a.scans, a.flown_m);
}

std::string title_words(const std::string& title) {
  std::string text;
  for (const char c : core::printable(title)) text += c == '\n' || c == '\t' || c == '"' ? ' ' : c;
  return text;
}

}  // namespace karst::survey_export
