// Queries that a campaign makes to the `karst` program before any flight: in separate processes, because a
// policy's plugin may crash when it is loaded.
#pragma once
#include <boost/property_tree/ptree.hpp>
#include <filesystem>
#include <string>

#include "sdk/campaign/plan/campaign.h"

namespace karst::campaign {

/// The mission of a contestant in a cave as `karst fly` would fly it. Throws core::InputError with karst's
/// message. `cave_cache`: the folder of --cave-cache; "": none.
boost::property_tree::ptree resolve(const Campaign& campaign, const ContestantSpec& who, const CaveSpec& cave,
                                    const std::filesystem::path& karst,
                                    const std::filesystem::path& cave_cache = {});

/// The file that provides a policy, or "".
std::string plugin_file(const std::string& policy, const std::string& plugin,
                        const std::filesystem::path& karst);

std::filesystem::path vehicle_file(const std::filesystem::path& karst, const std::string& vehicle);

/// "0.1.0+" and hashes of the program with its vehicle, and of the policy's plugin. Libraries linked into
/// karst, such as Embree, are not included.
std::string binary_version(const std::filesystem::path& karst, const std::string& vehicle,
                           const std::string& version, const std::string& plugin);

}  // namespace karst::campaign
