// What came of a replayed recording (docs/replay.md). Definitions: docs/metrics.md.
#pragma once
#include <optional>
#include <string>

#include "sdk/evaluation/record/run_record.h"

namespace karst::evaluation {

struct ReplayFigures {
  std::string recording;  // the last part of its path
  std::size_t scans = 0, lost = 0, closures = 0;
  /// Greatest distance between a scan's position before and after loops were closed; none without that.
  std::optional<double> correction_m;
};

/// None of a run that is no replay.
std::optional<ReplayFigures> replay_figures(const RunRecord& run);

}  // namespace karst::evaluation
