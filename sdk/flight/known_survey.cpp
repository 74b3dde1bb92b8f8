#include "sdk/flight/known_survey.h"

#include <memory>
#include <optional>
#include <utility>

#include "core_stack/common/error.h"
#include "sdk/survey/read_survey.h"
#include "sdk/survey_prior/survey_prior.h"

namespace karst::flight {

Mission with_survey(Mission mission) {
  SurveyKeys& keys = mission.survey;
  if (keys.file.empty()) return mission;
  // Before the survey is read: that takes longer.
  std::optional<core::Vec3> offset_m;
  if (!keys.offset.empty()) offset_m = survey_prior::read_offset(mission.file, "survey.offset", keys.offset);
  const survey::Survey survey = survey::read_survey(keys.file);
  if (!offset_m) offset_m = survey_prior::offset_of(keys.file, survey, mission.cave);
  core::SurveyPrior prior = survey_prior::prior_of(survey, *offset_m);
  if (prior.legs.empty()) throw core::InputError(keys.file, "", "has no leg underground");
  keys.offset = survey_prior::offset_text(*offset_m);
  mission.core.survey = {std::make_shared<const core::SurveyedPassages>(std::move(prior)), keys.hints};
  return mission;
}

}  // namespace karst::flight
