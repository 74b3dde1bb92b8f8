// Localization and mapping on recorded scans, one after another: what `karst replay` does.
#pragma once
#include <filesystem>
#include <functional>

#include "core_stack/localization/estimator.h"
#include "core_stack/localization/loam.h"
#include "core_stack/loops/loop_closing.h"
#include "core_stack/mapping/occupancy/voxel_map.h"
#include "plugins/replay/sensor_stream.h"

namespace karst::replay {

struct ReplayOptions {
  core::LoamOptions loam;
  core::EstimatorOptions estimator;
  core::MapOptions map;
  double mapping_range_m = 30;
  bool level = true;     // start attitude from the first IMU samples, if the recording has any
  double still_s = 0.3;  // duration of those samples
  bool loops = true;     // close loops, and correct trajectory and map by them
  core::LoopOptions loop_closing;
};
void describe(core::OptionTable& t, ReplayOptions& o);

/// What came of the search for loops.
struct LoopSummary {
  std::size_t closed = 0, unused = 0, submaps = 0, bytes = 0;
  double path_m = 0;
  double search_s = 0, slowest_s = 0;  // of wall clock: all, and after one scan
  double largest_correction_m = 0;     // of a scan's position
  bool mapped_again = false;
};

/// The result of a replay.
struct ReplaySummary {
  std::size_t scans = 0, lost = 0, imu_samples = 0, degenerate = 0;
  std::size_t points = 0, dropped_points = 0;
  bool without_times = false;
  double path_m = 0, slowest_s = 0, localization_s = 0;  // of wall clock: the slowest scan's, and all
  std::string last_problem;
  LoopSummary loops;
};

/// Called after each scan, with its number from 1.
using ReplayProgress =
    std::function<bool(std::size_t scan, const core::LoamPose& pose, const core::VoxelMap& map)>;

/// Opens the same recording once more, from its beginning.
using ReopenSensors = std::function<std::unique_ptr<SensorStream>()>;

/// Writes trajectory.tum in the recording's own time, map files and events into `run_dir`, which must be
/// fresh. Except for the map, the submaps (docs/loops.md) and a line for each scan, memory does not grow with
/// the recording. Stops early when `progress` returns false. Throws InputError when a file is damaged; the
/// output up to that scan is complete.
///
/// If loops are closed, the recording is read again, and all files are written anew with the corrected poses;
/// trajectory_odometry.tum keeps those of the odometry. Without `reopen` no loops are looked for.
ReplaySummary replay_recording(SensorStream& sensors, const ReplayOptions& options,
                               const std::filesystem::path& run_dir, const ReplayProgress& progress,
                               const ReopenSensors& reopen = {});

}  // namespace karst::replay
