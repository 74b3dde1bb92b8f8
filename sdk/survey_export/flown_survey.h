// The survey of what a flight mapped, in the frame of its map.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "sdk/survey/survey.h"
#include "sdk/survey_export/accuracy.h"
#include "sdk/survey_export/stations.h"

namespace karst::survey_export {

struct FlownSurvey {
  /// Station 0 is the entrance: the middle of the passage where the flight began. Legs of a run follow each
  /// other; those of which less than half was flown are `approximate`. Names are "NAME.1", "NAME.2", ...
  survey::Survey survey;
  std::string name;                       // of the survey: small letters, digits, - and _
  std::vector<double> leg_sd_m;           // of each leg, in each axis
  std::vector<bool> leg_is_new;           // not in the survey that the mission had; empty: it had none
  core::Vec3 start = core::Vec3::Zero();  // where the vehicle stood
  /// The map's origin in the coordinates of the survey that the mission had; zero without one.
  core::Vec3 offset_m = core::Vec3::Zero();
  Accuracy accuracy;
  std::size_t blocked_legs = 0;  // joined through cells that are not free
};

struct FlownInput {
  const core::VoxelMap* map = nullptr;
  std::vector<core::Vec3> flown;      // the trajectory; not empty
  std::vector<core::Vec3> frontiers;  // clusters that were left when exploration ended
  Accuracy accuracy;
  std::string name, title;
  std::string source;  // named in errors
};

/// Throws core::InputError naming the source if no passage was mapped around the start.
FlownSurvey flown_survey(const FlownInput& input, const StationOptions& options = {});

/// A survey's name in Survex and Therion of any text: "My Cave" gives "my_cave".
std::string survey_name(const std::string& text);

}  // namespace karst::survey_export
