// A made-up campaign: contestants whose coverage grows at different rates, caves of different sizes.
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "sdk/campaign/store/results.h"

namespace karst::test {

/// Every figure of every trial is set; `advantage` is how much faster each contestant explores than the one
/// after it, as a share; `noise` spreads the seeds.
campaign::CampaignResults fake_campaign(std::size_t contestants, std::size_t caves, std::int64_t seeds,
                                        double advantage = 0.1, double noise = 0.1);

/// The trial of finished run directories: contestant by policy, cave and seed as metrics.json says. What a
/// run does not know is NaN. Each run is flown `repeat` times, all but the first with figures changed a
/// little.
campaign::CampaignResults campaign_of_runs(const std::vector<std::filesystem::path>& runs, int repeat);

}  // namespace karst::test
