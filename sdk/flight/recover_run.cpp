#include "sdk/flight/recover_run.h"

#include <optional>

#include "core_stack/common/error.h"
#include "core_stack/mapping/octomap/octomap_io.h"
#include "core_stack/mission/recording/map_cells.h"
#include "sdk/evaluation/record/map_cells.h"
#include "sdk/evaluation/record/run_record.h"
#include "sdk/evaluation/team/team_folders.h"
#include "sdk/flight/run_files.h"

namespace karst::flight {
namespace {

namespace fs = std::filesystem;

/// If both files can be read.
std::optional<core::VoxelMap> whole_map(const fs::path& run_dir, RecoveredMap& out) {
  bool whole = true;
  std::optional<core::VoxelMap> map;
  for (const char* name : {"map.bt", "map.ot"}) try {
      std::error_code error;
      if (fs::exists(run_dir / name, error))
        map.emplace(core::read_octomap((run_dir / name).string()));
      else
        whole = false;
    } catch (const core::InputError& e) {
      out.notes.emplace_back(e.what());
      whole = false;
    }
  return whole ? std::move(map) : std::nullopt;
}

/// What no other reader misses; mission.info is read when the run is finished.
void note_missing(const fs::path& run_dir, std::vector<std::string>& notes) {
  for (const char* name : {"events.jsonl", "telemetry.csv", "trajectory.tum", "localization.csv",
                           "decisions.csv", "map_growth.bin", core::kMapCellsName, "timing.json"}) {
    std::error_code error;
    if (!fs::exists(run_dir / name, error)) notes.push_back(std::string(name) + ": is not there");
  }
  evaluation::read_table(run_dir / "localization.csv", {"believed", "problem"}, notes);
}

/// Occupied cells alone: a flight in lockstep does not record the free ones.
core::VoxelMap rock_of(const evaluation::RunRecord& run) {
  core::MapOptions options;
  options.resolution_m = run.map_resolution_m();
  core::VoxelMap map(options);
  for (const evaluation::OccupiedSpan& s : run.growth)
    if (s.until_ms == evaluation::OccupiedSpan::kNever) map.assign(s.key, 1, 1.0f);
  return map;
}

}  // namespace

bool is_whole(const fs::path& run_dir) {
  std::error_code error;
  for (const char* name : {"mission.info", "telemetry.csv", "trajectory.tum", "map.bt", "map.ot", "map.ply",
                           "timing.json", "metrics.json"})
    if (!fs::is_regular_file(run_dir / name, error)) return false;
  if (fs::exists(run_dir / "run.lock", error)) return false;
  std::vector<std::string> problems;
  if (!evaluation::read_json(run_dir / "metrics.json", problems).is_object() ||
      evaluation::read_settings(run_dir / "mission.info", problems).empty())
    return false;
  for (const char* map : {"map.bt", "map.ot"}) try {
      core::read_octomap((run_dir / map).string());
    } catch (const core::InputError&) {
      return false;
    }
  return evaluation::read_run(run_dir).last<core::event::Outcome>().has_value();
}

RecoveredMap recover_map(const fs::path& run_dir) {
  if (evaluation::is_team(run_dir))
    throw core::InputError(run_dir.string(), "", "is the run of a team: karst report evaluates what it kept");
  RecoveredMap out;
  const evaluation::RunRecord run = evaluation::read_run(run_dir);
  if (run.settings.empty() && run.events.empty() && run.telemetry.rows == 0 && run.growth.empty() &&
      !fs::exists(run_dir / core::kMapCellsName))
    throw core::InputError(run_dir.string(), "", "holds nothing of a flight");
  remove_stale_lock(run_dir);
  note_missing(run_dir, out.notes);
  if (const auto map = whole_map(run_dir, out)) {
    if (std::error_code error; !fs::exists(run_dir / "map.ply", error)) {
      core::write_ply(*map, (run_dir / "map.ply").string());
      out.written = {run_dir / "map.ply"};
    }
    return out;
  }
  if (!run.settings.empty() && run.setting("map.resolution").empty())
    out.notes.emplace_back("mission.info: has no map.resolution; 0.2 m is assumed");
  if (const auto map =
          evaluation::read_map_cells(run_dir / core::kMapCellsName, run.map_resolution_m(), out.notes)) {
    core::write_octomap(*map, (run_dir / "map").string());
    core::write_ply(*map, (run_dir / "map.ply").string());
    out.written = {run_dir / "map.bt", run_dir / "map.ot", run_dir / "map.ply"};
  } else if (const core::VoxelMap rock = rock_of(run); rock.occupied_cells() > 0) {
    core::write_ply(rock, (run_dir / "map.ply").string());
    out.written = {run_dir / "map.ply"};
    out.notes.emplace_back(
        "map_cells.bin: is not there, or holds nothing: only the rock of map_growth.bin is known");
  } else {
    out.notes.emplace_back("no map: neither map_cells.bin nor map_growth.bin holds a cell");
  }
  return out;
}

}  // namespace karst::flight
