// The three drawings of a survey: its legs, and the passage around them from left, right, up and down.
#pragma once
#include <optional>
#include <string>

#include "sdk/cave_drawing/drawing.h"
#include "sdk/survey/survey.h"

namespace karst::cave_drawing {

/// Between two stations the passage is the convex hull of what was measured at both, or else interpolated
/// (uncertain walls); along a leg that is steeper than 45 degrees it is also as deep as it is wide. What is
/// over ground is left out. Throws core::InputError that names `file` if no leg is underground, or a position
/// is not finite.
CaveDrawings survey_drawings(const survey::Survey& survey, std::optional<double> bearing_rad,
                             const std::string& file);

}  // namespace karst::cave_drawing
