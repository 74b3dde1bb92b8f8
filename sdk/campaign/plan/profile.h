// Named sets of mission settings with which a campaign is flown. A profile sets options that cost time.
// Policies that lie close together may change places between profiles (docs/compare.md). Settings of the
// campaign or of a contestant take precedence.
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

/// Throws core::InputError with the most similar name if there is no such profile.
const Profile& profile(const std::string& name);

}  // namespace karst::campaign
