// From a survey to a closed mesh to fly in.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "plugins/simulator/cave/cave.h"
#include "sdk/survey_cave/survey_part.h"
#include "sdk/survey_cave/survey_report.h"

namespace karst::survey_cave {

struct CaveOptions {
  PartOptions part;
  double resolution_m = 0.25;  // of the grid on which the walls are found
  double roughness_m = 0.1;    // greatest displacement of the walls
  std::uint64_t seed = 1;      // of the roughness
  double vehicle_width_m = 0.6;
  std::size_t max_triangles = 20'000'000;
  std::optional<cave::StartPose> start;  // none: one that suits
};

struct KeptStation {
  std::uint32_t station = 0;                   // index into Survey::stations
  core::Vec3 position_m = core::Vec3::Zero();  // in the cave
};

struct CaveFromSurvey {
  cave::TriangleMesh mesh;               // closed, metres, z up; the triangles face the air
  std::optional<cave::StartPose> start;  // none: no place was found that suits
  std::vector<KeptStation> stations;     // of the part, in the survey's order
  SurveyReport report;
};

/// Calls `progress(step, fraction done)` as it goes on. Throws core::InputError naming `file` if the part has
/// no passage, if the start lies in none, or if it takes more triangles or memory than there may be. The same
/// for the same survey, options and seed, to the byte.
CaveFromSurvey cave_from_survey(const std::string& file, const survey::Survey& survey,
                                const CaveOptions& options,
                                const std::function<void(const char*, double)>& progress = {});

}  // namespace karst::survey_cave
