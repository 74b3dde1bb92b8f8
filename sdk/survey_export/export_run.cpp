#include "sdk/survey_export/export_run.h"

#include <boost/property_tree/ptree.hpp>
#include <optional>
#include <utility>

#include "core_stack/common/error.h"
#include "core_stack/common/options.h"
#include "core_stack/mapping/occupancy/voxel_reader.h"
#include "core_stack/mapping/octomap/octomap_io.h"
#include "core_stack/mission/recording/run_event.h"
#include "sdk/evaluation/record/run_record.h"
#include "sdk/evaluation/record/whole_file.h"
#include "sdk/survey_export/las_points.h"
#include "sdk/survey_export/svx_file.h"
#include "sdk/survey_export/therion_file.h"

namespace karst::survey_export {
namespace {

namespace fs = std::filesystem;
using core::InputError;
using core::Vec3;

core::VoxelMap map_of(const fs::path& run) {
  if (!fs::is_directory(run)) throw InputError(run.string(), "", "no such run directory");
  const fs::path file = run / "map.bt";
  if (!fs::exists(file))
    throw InputError(file.string(), "",
                     fs::exists(run / "team.jsonl")
                         ? "is not there: this is a team's run; export one of its robots, such as " +
                               (run / "robot_1").string()
                         : "is not there: the map is written when a flight ends");
  return core::read_octomap(file.string());
}

/// That of the cave's file; of the run's folder if the run does not name its cave.
std::string cave_name(const fs::path& run) {
  if (const fs::path mission = run / "mission.info"; fs::exists(mission))
    if (const fs::path cave = core::read_info(mission.string()).get("cave.file", ""); cave.has_stem())
      return cave.stem().string();
  const fs::path folder = fs::absolute(run).lexically_normal();
  return (folder.has_filename() ? folder : folder.parent_path()).filename().string();
}

std::vector<Vec3> frontiers_left(const fs::path& run, std::vector<std::string>& problems) {
  evaluation::RunRecord record = evaluation::read_events_alone(run);
  problems.insert(problems.end(), record.problems.begin(), record.problems.end());
  std::vector<Vec3> out;
  if (const auto last = record.last<core::event::Frontiers>())
    for (const core::event::Cluster& c : last->clusters) out.push_back(c.centroid);
  return out;
}

/// The occupied cells that the cave's air touches.
std::vector<Vec3> wall_points(const RunSurvey& run, const Placing& placing) {
  std::vector<Vec3> points;
  core::VoxelReader reader(run.map);
  run.map.for_each_known([&](const core::CellKey& k, core::Cell c, float) {
    if (c != core::Cell::occupied) return;
    for (const core::CellKey& face : core::kFaces)
      if (reader.at(k + face) == core::Cell::free) {
        points.push_back(placed(placing, run.flown, run.map.center_of(k)));
        return;
      }
  });
  return points;
}

}  // namespace

RunSurvey survey_of_run(const fs::path& run, const std::string& name, const OtherPrior& other_prior) {
  core::VoxelMap map = map_of(run);
  const std::optional<KnownSurvey> known = survey_before(run, other_prior);
  std::vector<std::string> problems;
  const auto estimate = evaluation::read_tum(run / "trajectory.tum", problems);
  if (estimate.empty())
    throw InputError((run / "trajectory.tum").string(), "", "holds no pose: nothing was flown");
  FlownInput input;
  input.map = &map;
  for (const evaluation::StampedPose& p : estimate) input.flown.push_back(p.T_world_body.position);
  input.frontiers = frontiers_left(run, problems);
  const evaluation::Table localization =
      evaluation::read_table(run / "localization.csv", {"believed", "problem"}, problems);
  input.accuracy = accuracy_of(localization, estimate, map.resolution_m());
  input.name = survey_name(name);
  input.title = "Survey from a flight: " + cave_name(run);
  input.source = run.string();
  FlownSurvey flown = flown_survey(input);
  if (known) {
    flown.leg_is_new = new_legs(flown.survey, known->passages);
    flown.offset_m = known->offset_m;
  }
  return {std::move(map), std::move(flown), std::move(problems), known ? known->file : ""};
}

std::vector<fs::path> survey_files(const std::string& out) {
  std::vector<fs::path> files;
  for (const char* ending : {".svx", ".th", ".thconfig", "_scan.th", ".stl", ".ply", ".las"})
    files.emplace_back(out + ending);
  return files;
}

WallMesh write_survey(const RunSurvey& run, const Placing& placing, const std::string& out) {
  const std::vector<fs::path> files = survey_files(out);
  const std::string stem = fs::path(out).filename().string();
  evaluation::write_whole_file(files[0], svx_text(run.flown, placing));
  evaluation::write_whole_file(files[1], therion_text(run.flown, placing));
  evaluation::write_whole_file(files[2], thconfig_text(stem, placing));
  evaluation::write_whole_file(files[3], scan_text(run.flown, stem));
  WallMesh walls = wall_mesh(run.map);
  cave::write_mesh(files[4].string(), walls.mesh);
  evaluation::write_whole_file(files[5], ply_bytes(walls));
  evaluation::write_whole_file(files[6], las_bytes(wall_points(run, placing), files[6].string()));
  return walls;
}

}  // namespace karst::survey_export
