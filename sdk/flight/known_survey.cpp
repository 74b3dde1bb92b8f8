#include "sdk/flight/known_survey.h"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core_stack/common/error.h"
#include "core_stack/common/format_text.h"
#include "plugins/simulator/cave/cave.h"
#include "sdk/survey/read_survey.h"
#include "sdk/survey/survey_checks.h"
#include "sdk/survey_prior/survey_prior.h"

namespace karst::flight {
namespace {

/// Hints of passages so far away say little of what a vehicle meets first. A survey may be of a part behind.
constexpr double kFarFromStart_m = 100;

/// Of the simulator, whose flights have the frame of the cave; none if the cave names no start. The flight
/// itself refuses a bad start, with a better message.
std::optional<core::Vec3> start_in_cave(const Mission& mission) {
  if (mission.vehicle != "simulator" || mission.cave.empty()) return std::nullopt;
  try {
    return cave::describe_cave(mission.cave, mission.start, mission.mesh).start.position;
  } catch (const core::InputError&) {
    return std::nullopt;
  }
}

std::string fit_text(const std::optional<survey_prior::StationFit>& fit, bool given) {
  if (!fit)
    return given ? "as survey.offset says"
                 : "as no table of stations (.stations.csv) lies beside the cave; else give survey.offset";
  if (fit->names == 0) return "as survey.offset says; no station of the cave has the same name";
  const std::string text = core::format_text(
      "%zu of its stations have names of the cave's; they lie %.2f m (median) and at most %.2f m from those",
      fit->names, fit->median_m, fit->greatest_m);
  if (fit->median_m <= survey_prior::kMostResidual_m) return text;
  return text + ": survey.offset contradicts the names";
}

std::vector<std::string> notes_of(const Mission& mission, const survey::Survey& survey,
                                  const core::SurveyPrior& prior, const core::Vec3& offset_m,
                                  const std::string& fit) {
  std::vector<std::string> notes{"lies in the cave with the offset " + survey_prior::offset_text(offset_m) +
                                 ": " + fit};
  if (const auto start = start_in_cave(mission))
    if (const double away_m = survey_prior::distance_to_legs_m(prior, *start); away_m > kFarFromStart_m)
      notes.push_back(core::format_text(
          "the start is %.0f m from its nearest leg: does survey.offset fit the cave?", away_m));
  for (const std::string& check : survey::survey_checks(survey)) notes.push_back(check);
  return notes;
}

}  // namespace

Mission with_survey(Mission mission, const std::function<void(const std::string&)>& note) {
  SurveyKeys& keys = mission.survey;
  if (keys.file.empty()) return mission;
  // Before the survey is read: that takes longer.
  std::optional<core::Vec3> given_m;
  if (!keys.offset.empty()) given_m = survey_prior::read_offset(mission.file, "survey.offset", keys.offset);
  const survey::Survey survey = survey::read_survey(keys.file);
  const auto fit = survey_prior::station_fit(keys.file, survey, mission.cave, given_m);
  const core::Vec3 offset_m = fit ? fit->offset_m : given_m.value_or(core::Vec3::Zero());
  core::SurveyPrior prior = survey_prior::prior_of(survey, offset_m);
  if (prior.legs.empty()) throw core::InputError(keys.file, "", "has no leg underground");
  if (note)
    for (const std::string& text :
         notes_of(mission, survey, prior, offset_m, fit_text(fit, given_m.has_value())))
      note(keys.file + ": " + text);
  keys.offset = survey_prior::offset_text(offset_m);
  mission.core.survey = {std::make_shared<const core::SurveyedPassages>(std::move(prior)), keys.hints};
  return mission;
}

}  // namespace karst::flight
