// The volume of the cave known to a team over time.
#pragma once
#include "sdk/evaluation/record/run_record.h"

namespace karst::evaluation {

struct VolumeCurve {
  std::vector<double> t_s, explored_m3;
};

/// Known-free volume of the union of the robots' maps at every second of the team's time from the first row
/// of telemetry on. Only each robot's own volume is recorded over time. What several know is taken from the
/// rock cells, whose times are recorded: the sum of the robots' volumes times (cells of the united map) /
/// (sum of the robots' cells), both as of then. Maps that are off by a cell share fewer cells than they share
/// space: the overlap so found is scaled such that at the end it is exact, if `final_m3` is known, the united
/// map's volume. No less than any robot's own, and never more than later. Of one robot it is its own volume.
/// Empty without telemetry.
VolumeCurve team_volume_curve(const std::vector<RunRecord>& robots, const std::vector<OccupiedSpan>& united,
                              std::optional<double> final_m3);

}  // namespace karst::evaluation
