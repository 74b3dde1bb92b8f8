// Results as a campaign's store, for what reads one.
#pragma once
#include <filesystem>
#include <string>

#include "sdk/campaign/store/results.h"

namespace karst::test {

/// Makes the store of a campaign in `folder`, with these results and a definition in the store's form.
void store_campaign(const campaign::CampaignResults& results, const std::filesystem::path& folder,
                    const std::string& definition = "");

}  // namespace karst::test
