// A contestant in a paper's words: its policy with version, and what sets it apart from the others.
#pragma once
#include <string>

#include "sdk/campaign/store/results.h"

namespace karst::campaign {

/// "far (nearest_frontier 1.0.0; horizon = 60 m)": the parameters in which contestants of this policy differ,
/// and the mission settings that it has for itself.
std::string contestant_text(const CampaignResults& results, std::size_t contestant);

}  // namespace karst::campaign
