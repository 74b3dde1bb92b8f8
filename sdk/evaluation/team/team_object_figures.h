// Figures of a team's search for objects of interest. Definitions: docs/metrics.md.
#pragma once
#include <string>
#include <vector>

#include "sdk/evaluation/metrics/object_figures.h"
#include "sdk/evaluation/team/team_record.h"

namespace karst::evaluation {

/// From the team's log and its robots' ground truth. Damaged lines are added to `problems`.
ObjectFigures team_object_figures(const TeamRecord& team, std::vector<std::string>& problems);

}  // namespace karst::evaluation
