// Numbers of legs and sections as both Survex and Therion read them.
#pragma once
#include <string>

#include "sdk/survey_export/flown_survey.h"

namespace karst::survey_export {

/// Station name without the survey's: "12".
std::string station_word(const FlownSurvey& flown, std::uint32_t station);
/// "1 2 8.1234 12.3456 -3.2100", or "1 2 8.1234 - down": from, to, tape in metres, compass and clino in
/// degrees. To a tenth of a millimetre, so that long traverses come out to the centimetre.
std::string leg_words(const FlownSurvey& flown, const survey::Leg& leg);
/// "1 0.52 1.20 - 0.80": station, left, right, up, down in metres; - where nothing was seen.
std::string section_words(const FlownSurvey& flown, const survey::Section& section);
/// In centimetres, at least one: standard deviations of a tape, and of the angles that move a leg's end as
/// far across.
struct LegDeviations {
  double tape_m = 0, angle_deg = 0;
  bool operator==(const LegDeviations&) const = default;
};
LegDeviations deviations_of(const FlownSurvey& flown, std::size_t leg);
/// What was assumed for the accuracy, in a sentence.
std::string accuracy_words(const Accuracy& accuracy);
/// In one line of UTF-8, without quotes and control characters: Therion reads no file with other bytes.
std::string title_words(const std::string& title);

}  // namespace karst::survey_export
