// The figures of one run, as metrics.json holds them. Definitions: docs/metrics.md.
#pragma once
#include <array>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>

#include "core_stack/common/geometry.h"
#include "core_stack/mapping/occupancy/voxel_map.h"
#include "sdk/evaluation/record/run_record.h"

namespace karst::evaluation {

/// Ground truth of the cave; unknown parts stay empty, and the figures that need them are null.
struct Truth {
  std::optional<double> reachable_volume_m3;                  // |R|
  std::function<bool(const core::Vec3&)> is_reachable;        // whether a point in the world frame lies in R
  std::function<double(const core::Vec3&)> distance_to_rock;  // metres to the nearest rock surface
  std::vector<core::CellKey> surface;                         // rock cells that bound R, on the map's grid
  /// For a run with a colour camera: rock cells that some picture shows well enough, sorted.
  std::optional<std::vector<core::CellKey>> imaged_rock;
};

/// All names are present, null where the value is unknown, but for those of a survey, which are present if
/// the mission has one, and of a replay. Depends only on the record and the ground truth; numbers are rounded
/// to six decimals, so that replays of a run give the same bytes.
nlohmann::ordered_json evaluate(const RunRecord& run, const core::VoxelMap* map, const Truth& truth);

/// Reads the run and its map and evaluates them. Throws InputError only if `run_dir` is not a directory;
/// other missing or damaged inputs are listed in `problems`, if given.
nlohmann::ordered_json evaluate_run(const std::filesystem::path& run_dir, const Truth& truth,
                                    std::vector<std::string>* problems = nullptr);

/// Writes `metrics` to run_dir/metrics.json, completely or not at all; throws InputError if writing fails.
void write_metrics(const std::filesystem::path& run_dir, const nlohmann::ordered_json& metrics);

/// Figures of a map that require ground truth of the cave: null without it.
inline constexpr std::array kCaveFigures = {"reachable_volume_m3",
                                            "coverage",
                                            "coverage_auc",
                                            "coverage_at_25",
                                            "coverage_at_50",
                                            "coverage_at_75",
                                            "t50_s",
                                            "t90_s",
                                            "t95_s",
                                            "restricted_t50_s",
                                            "restricted_t90_s",
                                            "restricted_t95_s",
                                            "surface_seen",
                                            "surface_imaged",
                                            "map_error_mean_m",
                                            "map_error_std_m"};

}  // namespace karst::evaluation
