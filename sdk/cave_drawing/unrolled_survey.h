// The legs of a survey laid out for an extended profile, from its entrance on.
//
// A leg goes on in the direction of the one before it, to the right at first. `extend left` and `right` set
// the direction from the leg's first station to its second, `reverse` turns round, and `vertical` stays where
// it is. A leg that is to be ignored leads nowhere: its far end is reached by another way.
#pragma once
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "sdk/survey/survey.h"

namespace karst::cave_drawing {

struct UnrolledSurvey {
  std::uint32_t first = 0;                                     // the station where it begins
  std::vector<std::optional<double>> s_m;                      // of each station: where it is drawn first
  std::vector<std::optional<std::pair<double, double>>> legs;  // of each leg: both ends; none: not drawn
};

/// A leg is as long as it is horizontally. Parts without a way between them are laid out side by side.
/// `survey` has a leg underground.
UnrolledSurvey unrolled_survey(const survey::Survey& survey);

}  // namespace karst::cave_drawing
