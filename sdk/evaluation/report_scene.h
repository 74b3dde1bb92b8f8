// The parts of the report's data that are drawn in 3D. Formats: docs/report.md
#pragma once
#include <nlohmann/json.hpp>

#include "sdk/evaluation/run_record.h"

namespace karst::evaluation {

/// Points of the map as base64 arrays; null without any. What is left out is added to `problems`.
nlohmann::ordered_json scene_cloud(const RunRecord& run, double duration_s,
                                   std::vector<std::string>& problems);
/// Poses as base64 float32: times, positions and headings; null without any.
nlohmann::ordered_json scene_track(const std::vector<StampedPose>& poses);
/// Frontier clusters as [[t, [[x, y, z, cells], ...]], ...].
nlohmann::ordered_json scene_frontiers(const RunRecord& run, std::vector<std::string>& problems);
/// Paths planned as [[t, [[x, y, z], ...]], ...].
nlohmann::ordered_json scene_plans(const RunRecord& run, std::vector<std::string>& problems);
/// What the policy drew, by decision: [[t, [{shape, points, rgb, text}, ...]], ...].
nlohmann::ordered_json scene_drawings(const RunRecord& run, std::vector<std::string>& problems);

}  // namespace karst::evaluation
