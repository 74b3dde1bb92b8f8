// From legs with left, right, up and down, and from splays, to tubes.
#pragma once
#include <vector>

#include "sdk/survey_cave/passage_graph.h"
#include "sdk/survey_cave/tube.h"

namespace karst::survey_cave {

/// Where dimensions of a leg were not measured.
struct GuessedLeg {
  std::uint32_t leg = 0;  // index into Survey::legs
  double without_m = 0;   // nothing was measured; half of the leg counts for each of its ends
  double partly_m = 0;    // something was
};

struct Passages {
  std::vector<Tube> tubes;  // by passage, those of a passage in the order of the legs
  std::vector<GuessedLeg> guessed;
  double measured_half_width_m = 0, measured_up_m = 0, measured_down_m = 0;  // medians; 0: none was measured
  double defaults_m = 0;  // where nothing connected was measured, and the medians (or 1 m) stand in
  double splays_m = 0;    // with sections from splays
  double shafts_m = 0;    // so steep that front and back are taken to be as far as left and right
  double widened_m = 0;   // widened or heightened to `least_m`
  std::size_t sections_from_splays = 0;
};

/// A section stands in a vertical plane across the passage: along a gentle leg left and right are horizontal,
/// up and down vertical, as they are measured. Where two legs of a passage meet it halves the angle between
/// them. From a slope of 49 degrees on the plane tilts, and from 72 degrees on it is across the leg.
///
/// At each station the two legs that turn least go on as one passage; a leg that is left over begins there
/// with its own section. Sections come from at least four splays across the passage, else from left, right,
/// up and down. What is missing is interpolated along the legs. Widths and heights are at least `least_m`.
Passages passages_of(const survey::Survey& survey, const SurveyPart& part, const PassageGraph& graph,
                     const core::Vec3& offset_m, double least_m);

}  // namespace karst::survey_cave
