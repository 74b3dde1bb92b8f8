// What `karst cave from-survey` says of the cave that it made.
#pragma once
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sdk/survey_cave/cave_from_survey.h"

namespace karst::tools {

/// Lines for the screen, and for the comments of the .info file. `mesh_bytes`: size of the mesh's file.
std::vector<std::string> survey_lines(const survey::Survey& survey, const survey_cave::CaveFromSurvey& made,
                                      std::uintmax_t mesh_bytes);

/// All of it, for programs.
nlohmann::ordered_json survey_json(const survey::Survey& survey, const survey_cave::CaveFromSurvey& made,
                                   std::uintmax_t mesh_bytes);

/// The stations as a table: name, x, y, z in the cave, and what is noted of them.
std::string stations_csv(const survey::Survey& survey, const survey_cave::CaveFromSurvey& made);

}  // namespace karst::tools
