// What a flight added to the map of an earlier one that its mission names. Definitions: docs/metrics.md.
#pragma once
#include <optional>

#include "sdk/evaluation/record/run_record.h"

namespace karst::evaluation {

struct EarlierMapFigures {
  bool found = false;                // the vehicle's place in the earlier map
  std::optional<double> earlier_m3;  // free volume of the earlier map; none unless found
};

/// None if the mission has no earlier map, or nothing of it is recorded.
std::optional<EarlierMapFigures> earlier_map_figures(const RunRecord& run);

}  // namespace karst::evaluation
