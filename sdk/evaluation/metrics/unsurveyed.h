// What a flight explored beyond the survey that its mission names. Definitions: docs/metrics.md.
#pragma once
#include <optional>

#include "sdk/evaluation/record/run_record.h"

namespace karst::evaluation {

struct UnsurveyedFigures {
  double volume_m3 = 0;                // at the end
  std::optional<double> time_to_50_s;  // from take-off; none: never so much
};

/// None if the mission has no survey, or nothing of it is recorded.
std::optional<UnsurveyedFigures> unsurveyed_figures(const RunRecord& run);

}  // namespace karst::evaluation
