#include "sdk/survey_export/new_legs.h"

#include <boost/property_tree/ptree.hpp>

#include "core_stack/common/counted.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/options.h"
#include "sdk/survey/read_survey.h"
#include "sdk/survey_prior/survey_prior.h"

namespace karst::survey_export {

std::optional<core::SurveyedPassages> survey_before(const std::filesystem::path& run) {
  const std::string mission = (run / "mission.info").string();
  if (!std::filesystem::exists(mission)) return std::nullopt;
  const boost::property_tree::ptree tree = core::read_info(mission);
  const std::string file = tree.get("survey.file", "");
  if (file.empty()) return std::nullopt;
  const core::Vec3 offset_m =
      survey_prior::read_offset(mission, "survey.offset", tree.get("survey.offset", "0 0 0"));
  return core::SurveyedPassages(survey_prior::prior_of(survey::read_survey(file), offset_m));
}

std::vector<bool> new_legs(const survey::Survey& flown, const core::SurveyedPassages& known) {
  constexpr int kPlaces = 16;  // along a leg
  std::vector<bool> out;
  for (const survey::Leg& leg : flown.legs) {
    const core::Vec3 from = flown.stations[leg.from].position_m, to = flown.stations[leg.to].position_m;
    int beyond = 0;
    for (int i = 0; i < kPlaces; ++i)
      beyond += known.distance_m(from + (i + 0.5) / kPlaces * (to - from)) > core::kBeyondSurvey_m ? 1 : 0;
    out.push_back(2 * beyond >= kPlaces);
  }
  return out;
}

NewSum new_sum(const FlownSurvey& flown) {
  NewSum sum;
  for (std::size_t i = 0; i < flown.survey.legs.size(); ++i) {
    if (!is_new(flown, i)) continue;
    ++sum.legs;
    sum.length_m += flown.survey.legs[i].length_m.value_or(0);
  }
  return sum;
}

std::string new_words(const FlownSurvey& flown) {
  if (flown.leg_is_new.empty()) return "";
  const NewSum sum = new_sum(flown);
  return "new: " + core::counted(sum.legs, "leg") +
         core::format_text(", %.1f m beyond the survey", sum.length_m);
}

}  // namespace karst::survey_export
