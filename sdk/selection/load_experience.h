// Experience from files: distilled ones, and stores of campaigns.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "sdk/selection/experience.h"

namespace karst::selection {

/// Of all files together: an experience (.info), a campaign's store or its folder. Caves of a store that were
/// not described yet are described from their files, and the store keeps that; `tell` hears of each, and of
/// those whose file is gone. Throws InputError.
Experience load_experience(const std::vector<std::string>& files,
                           const std::function<void(const std::string&)>& tell);

/// SHA-256 of a cave's mesh, as campaigns tell caves apart by; "" of what is no mesh. Throws InputError.
std::string mesh_hash_of(const std::string& cave_file, const std::string& start);

/// The experience that comes with this installation; "" if it has none.
std::string installed_experience();

}  // namespace karst::selection
