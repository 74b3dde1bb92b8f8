// The team's objects of interest, as files list them.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "core_stack/team/team_objects.h"

namespace karst::core {

/// Objects of all finders together.
nlohmann::json list_of(const std::vector<TeamObject>& objects);

}  // namespace karst::core
