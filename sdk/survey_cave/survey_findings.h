// What a survey tells of a cave beside its shape.
#pragma once
#include <optional>
#include <vector>

#include "sdk/survey_cave/passages.h"
#include "sdk/survey_cave/survey_report.h"

namespace karst::survey_cave {

/// Metres of a tube that are narrower or lower than `width_m`, at steps of about half a metre.
double narrow_m(const Tube& tube, double width_m);

/// Lengths, guesses, flooded and blocked parts, narrow passages, and parts that are not connected.
void tell_of_passages(const survey::Survey& survey, const SurveyPart& part, const PassageGraph& graph,
                      const Passages& passages, SurveyReport& report);

/// Metres of the legs that a vehicle gets to from a place, along legs that are nowhere narrower than it.
double within_reach_m(const survey::Survey& survey, const PassageGraph& graph, const Passages& passages,
                      double width_m, const core::Vec3& from);

}  // namespace karst::survey_cave
