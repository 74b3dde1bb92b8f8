#include "sdk/survey_export/new_legs.h"

#include <boost/property_tree/ptree.hpp>

#include "core_stack/common/counted.h"
#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/options.h"
#include "sdk/survey/read_survey.h"
#include "sdk/survey_prior/survey_prior.h"

namespace karst::survey_export {

namespace {

survey::Survey read_named(const std::string& mission, const std::string& file) {
  try {
    return survey::read_survey(file);
  } catch (const core::InputError& e) {
    throw core::InputError(
        mission, "survey.file",
        std::string(e.what()) +
            "; if the survey was moved, say where with --prior FILE; --prior none leaves it out");
  }
}

}  // namespace

std::optional<KnownSurvey> survey_before(const std::filesystem::path& run, const OtherPrior& other) {
  const std::string mission = (run / "mission.info").string();
  boost::property_tree::ptree tree;
  if (std::filesystem::exists(mission)) tree = core::read_info(mission);
  const std::string file = other ? other->string() : tree.get("survey.file", "");
  if (file.empty()) return std::nullopt;
  std::optional<core::Vec3> offset_m;
  if (const std::string text = tree.get("survey.offset", ""); !text.empty())
    offset_m = survey_prior::read_offset(mission, "survey.offset", text);
  const survey::Survey survey = other ? survey::read_survey(file) : read_named(mission, file);
  if (!offset_m)
    if (const auto fit = survey_prior::station_fit(file, survey, tree.get("cave.file", ""), std::nullopt))
      offset_m = fit->offset_m;
  const core::Vec3 at_m = offset_m.value_or(core::Vec3::Zero());
  return KnownSurvey{file, core::SurveyedPassages(survey_prior::prior_of(survey, at_m)), at_m};
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
