// Pieces of a plan as text, for its definition, hashes and messages.
#pragma once
#include <boost/property_tree/ptree.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "sdk/campaign/store/results.h"

namespace karst::campaign {

std::string info_text(const boost::property_tree::ptree& tree);
std::string seeds_text(const std::vector<std::int64_t>& seeds);

/// What a definition tells of how all flew: fills what it knows of profile, metric and shared settings.
/// Throws InputError for one that cannot be read.
void read_conditions(const std::string& definition, const std::string& source, CampaignResults& results);

}  // namespace karst::campaign
