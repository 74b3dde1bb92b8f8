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

/// What is known of the cave itself; leave empty what is not, and the figures that need it are null.
struct Truth {
  std::optional<double> reachable_volume_m3;                  // |R|
  std::function<bool(const core::Vec3&)> is_reachable;        // whether a point of the world lies in R
  std::function<double(const core::Vec3&)> distance_to_rock;  // metres to the nearest rock surface
  std::vector<core::CellKey> surface;                         // cells of rock that bound R, on the map's grid
  /// Of a run with a colour camera: cells of rock that some picture shows well enough, sorted.
  std::optional<std::vector<core::CellKey>> imaged_rock;
};

/// Every name is there, null where the value is not known. Depends on the record and the truth only, and
/// numbers are rounded to six decimals: replays of a run give the same bytes.
nlohmann::ordered_json evaluate(const RunRecord& run, const core::VoxelMap* map, const Truth& truth);

/// Reads the run and its map and evaluates them. Throws InputError only if `run_dir` is no directory;
/// what else is missing or damaged stands in `problems`, if given.
nlohmann::ordered_json evaluate_run(const std::filesystem::path& run_dir, const Truth& truth,
                                    std::vector<std::string>* problems = nullptr);

/// Writes `metrics` as run_dir/metrics.json, whole or not at all; throws InputError when the disk refuses.
void write_metrics(const std::filesystem::path& run_dir, const nlohmann::ordered_json& metrics);

/// Figures of a map that only the cave itself tells: null without it.
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
