// Writes a run directory as cavers have their caves: a survey, its walls and its points.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "sdk/survey_export/new_legs.h"
#include "sdk/survey_export/placing.h"
#include "sdk/survey_export/wall_mesh.h"

namespace karst::survey_export {

/// Of the run: the map, the vehicle's own trajectory, what its localization says of itself, and the frontiers
/// that were left; and the survey that its mission names. Never ground truth. `name`: of the survey. Throws
/// core::InputError if there is no map or no trajectory, or if that survey cannot be read any more.
/// `other_prior` takes the place of that survey.
struct RunSurvey {
  core::VoxelMap map;
  FlownSurvey flown;
  std::vector<std::string> problems;  // of the run's files
  std::string prior;                  // file of the survey that it was compared with; "": none
};
RunSurvey survey_of_run(const std::filesystem::path& run, const std::string& name,
                        const OtherPrior& other_prior = {});

/// The files for `out`, a path without ending, in the order in which they are written.
std::vector<std::filesystem::path> survey_files(const std::string& out);

/// Writes them. Throws core::InputError naming the file that cannot be written.
WallMesh write_survey(const RunSurvey& run, const Placing& placing, const std::string& out);

}  // namespace karst::survey_export
