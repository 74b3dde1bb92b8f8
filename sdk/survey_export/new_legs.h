// What of a flight's survey is new: not in the survey that its mission had as hints.
#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/mapping/prior/surveyed_passages.h"
#include "sdk/survey_export/flown_survey.h"

namespace karst::survey_export {

struct KnownSurvey {
  std::string file;
  core::SurveyedPassages passages;  // as they lie in the map
  core::Vec3 offset_m;              // the map's origin in the coordinates of the survey
};

/// Takes the place of the survey that a mission names; an empty path: none does.
using OtherPrior = std::optional<std::filesystem::path>;

/// The survey that the run's mission names, or the other one at the mission's survey.offset (without one,
/// where the stations of the cave have it); none if there is none. Throws core::InputError if it cannot be
/// read, naming the mission file if that names the survey.
std::optional<KnownSurvey> survey_before(const std::filesystem::path& run, const OtherPrior& other = {});

/// Of each leg, whether at least half of it is farther than core::kBeyondSurvey_m from the known passages.
std::vector<bool> new_legs(const survey::Survey& flown, const core::SurveyedPassages& known);

inline bool is_new(const FlownSurvey& flown, std::size_t leg) {
  return !flown.leg_is_new.empty() && flown.leg_is_new[leg];
}

struct NewSum {
  std::size_t legs = 0;
  double length_m = 0;
};
NewSum new_sum(const FlownSurvey& flown);

/// "new: 3 legs, 21.4 m beyond the survey"; "" if the mission had no survey.
std::string new_words(const FlownSurvey& flown);

}  // namespace karst::survey_export
