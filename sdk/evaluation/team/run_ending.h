// How the flights of a run directory ended: its events read, and of the rest only metrics.json.
#pragma once
#include <filesystem>
#include <vector>

#include "sdk/evaluation/metrics/ending.h"

namespace karst::evaluation {

/// One for each vehicle: of a team robot 1 first. Without events, or if a team's folders are not all there,
/// an ending says nothing.
std::vector<Ending> read_endings(const std::filesystem::path& run_dir);

/// Of the vehicle, or of the whole team.
inline Ending read_ending(const std::filesystem::path& run_dir) {
  return joint_ending(read_endings(run_dir));
}

}  // namespace karst::evaluation
