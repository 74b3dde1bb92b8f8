// The legs of a survey laid out for an extended profile, from its entrance on.
//
// A leg goes on in the direction of the one before it, to the right at first. `extend left` and `right` set
// the direction from the leg's first station to its second, `reverse` turns round, and `vertical` stays where
// it is. A leg that is to be ignored leads nowhere: its far end is reached by another way. Where no leg says
// so, the longest way goes to the right, and side passages to where they have room (strip_places.h).
#pragma once
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "sdk/survey/survey.h"

namespace karst::cave_drawing {

/// A station that is drawn at two places: a loop is cut there, or a passage is moved aside.
struct StationTwice {
  std::uint32_t station = 0;
  double s_m = 0, again_s_m = 0;
  bool is_moved = false;  // the passage that begins at the second place
};

struct UnrolledSurvey {
  std::uint32_t first = 0;                                     // the station where it begins
  std::vector<std::optional<double>> s_m;                      // of each station: where it is drawn first
  std::vector<std::optional<std::pair<double, double>>> legs;  // of each leg: both ends; none: not drawn
  std::vector<StationTwice> twice;
};

/// A leg is as long as it is horizontally. Parts without a way between them are laid out side by side.
/// `survey` has a leg underground.
UnrolledSurvey unrolled_survey(const survey::Survey& survey);

}  // namespace karst::cave_drawing
