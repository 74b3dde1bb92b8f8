// Trees out of INFO text, whoever wrote it: what goes beyond the bounds of info_lines.h is refused before
// Boost's reader sees it. `read_info` of options.h reads a file.
#pragma once
#include <boost/property_tree/ptree_fwd.hpp>
#include <string>
#include <string_view>

#include "core_stack/common/info_lines.h"

namespace karst::core {

/// Reads INFO text that stands in something else, which `source` names; throws InputError ("SOURCE: line N:
/// reason").
boost::property_tree::ptree parse_info(std::string_view text, const std::string& source);

/// Reads a file of the user's own, which may `#include` others; throws InputError.
boost::property_tree::ptree read_including_info(const std::string& file);

}  // namespace karst::core
