// Where a flight through a surveyed cave begins.
#pragma once
#include <optional>

#include "plugins/simulator/cave/propose_start.h"
#include "sdk/survey_cave/passages.h"

namespace karst::survey_cave {

/// The place nearest to an entrance, at most 60 m along the passages, that suits; entrances of the longest
/// connected part first. Else at the roomiest stations, else anywhere in the cave; none if nothing suits.
std::optional<cave::StartPose> start_in_survey(const cave::RayScene& scene, const survey::Survey& survey,
                                               const PassageGraph& graph, const Passages& passages);

}  // namespace karst::survey_cave
