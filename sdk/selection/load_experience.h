// Loads experience from experience files and stores of campaigns.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "sdk/selection/experience.h"

namespace karst::selection {

/// Loads all files together: an experience (.info), a campaign's store or its folder. Caves of a store
/// without a description are described from their files, and the store keeps the result; `tell` is called for
/// each of them, and for those whose file is missing. Throws InputError.
Experience load_experience(const std::vector<std::string>& files,
                           const std::function<void(const std::string&)>& tell);

/// The hash of a cave's mesh that identifies caves in campaigns; "" if it is not a mesh. Throws InputError.
std::string mesh_hash_of(const std::string& cave_file, const std::string& start);

/// The experience installed with karst; "" if there is none.
std::string installed_experience();

}  // namespace karst::selection
