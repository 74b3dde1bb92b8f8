// The parts of the report's data that are drawn in 3D. Formats: docs/report.md
#pragma once
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "sdk/evaluation/record/run_record.h"

namespace karst::evaluation {

/// A map's cells as arrays for the page, three numbers per cell where noted (docs/report.md).
struct CloudArrays {
  double cell_m = 0, tick_s = 0;
  std::array<double, 3> origin{};
  std::vector<std::int16_t> cells;  // x, y, z: offsets from the origin's cell
  std::vector<std::uint16_t> from, until;
  std::vector<std::int8_t> normals;  // x, y, z
};
/// At most `max_points` cells, none smaller than `min_cell_m`, in the order of their keys; cells left out are
/// reported in `problems`.
CloudArrays cloud_arrays(const RunRecord& run, std::size_t max_points, double min_cell_m, double tick_ms,
                         std::vector<std::string>& problems);

/// Points of the map as base64 arrays; null if there are none. Points left out are reported in `problems`.
nlohmann::ordered_json scene_cloud(const RunRecord& run, double duration_s,
                                   std::vector<std::string>& problems);
/// Poses as base64 float32: times, positions and headings; null if there are none.
nlohmann::ordered_json scene_track(const std::vector<StampedPose>& poses, std::size_t max_poses = 12000);
/// Frontier clusters as [[t, [[x, y, z, cells, id], ...]], ...].
nlohmann::ordered_json scene_frontiers(const RunRecord& run, std::vector<std::string>& problems);
/// Paths planned as [[t, [[x, y, z], ...]], ...].
nlohmann::ordered_json scene_plans(const RunRecord& run, std::vector<std::string>& problems);
/// The bodies of the region that the vehicle may fly in: [{keep: "in" or "out", outline: [[x, y], ...], low,
/// high}, ...]; an open height ends with the map. null without a region.
nlohmann::ordered_json scene_region(const RunRecord& run, std::vector<std::string>& problems);
/// Closures of loops: [[from, to, used], ...], two places that are one in metres, and whether the trajectory
/// was corrected by it; null if there are none.
nlohmann::ordered_json scene_loops(const RunRecord& run);
/// Objects of interest found by each time: [[t, [[x, y, z, what], ...]], ...], one entry per change.
nlohmann::ordered_json scene_objects(const RunRecord& run);
/// The policy's drawings by decision: [[t, [{shape, points, rgb, text}, ...]], ...].
nlohmann::ordered_json scene_drawings(const RunRecord& run, std::vector<std::string>& problems);

}  // namespace karst::evaluation
