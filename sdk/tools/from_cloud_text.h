// What `karst cave from-cloud` says of the cave that it made.
#pragma once
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sdk/cave_from_cloud/cave_from_cloud.h"

namespace karst::tools {

/// Lines for the screen, and for the comments of the .info file. `mesh_bytes`: size of the mesh's file.
std::vector<std::string> report_lines(const from_cloud::CaveFromCloud& made, std::uintmax_t mesh_bytes);

/// All of it, for programs.
nlohmann::ordered_json report_json(const from_cloud::CaveFromCloud& made, std::uintmax_t mesh_bytes);

}  // namespace karst::tools
