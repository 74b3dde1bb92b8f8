// Named sets of mission settings a campaign is flown with. A profile sets what costs time and, as measured,
// does not change which policy is better (docs/compare.md); what the campaign or a contestant says itself
// wins.
#pragma once
#include <string>
#include <vector>

#include "sdk/campaign/plan/campaign.h"

namespace karst::campaign {

struct Profile {
  std::string name, meaning;
  Settings settings;
};

const std::vector<Profile>& profiles();

/// Throws core::InputError naming the nearest one if there is none of this name.
const Profile& profile(const std::string& name);

}  // namespace karst::campaign
