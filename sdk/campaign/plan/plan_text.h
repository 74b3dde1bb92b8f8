// Pieces of a plan as text, for its definition, hashes and messages.
#pragma once
#include <boost/property_tree/ptree.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace karst::campaign {

std::string info_text(const boost::property_tree::ptree& tree);
std::string seeds_text(const std::vector<std::int64_t>& seeds);

}  // namespace karst::campaign
