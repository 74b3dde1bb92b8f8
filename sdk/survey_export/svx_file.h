// The survey of a flight as Survex reads it (.svx).
//
// survey::write_survex writes what `cavern` is to adjust, with names for its speed; this is for people.
#pragma once
#include <string>

#include "sdk/survey_export/placing.h"

namespace karst::survey_export {

/// Legs with their standard deviations, the fixed entrance, passages by left, right, up and down. Survex
/// knows neither approximate legs nor continuations: they are comments.
std::string svx_text(const FlownSurvey& flown, const Placing& placing);

}  // namespace karst::survey_export
