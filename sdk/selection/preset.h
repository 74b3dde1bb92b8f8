// A policy with its parameters in a file of its own: written by `karst tune` and `karst select`, read by
// `karst fly --preset`, and suitable for inclusion in a mission file without a policy section.
//
//   policy { name unknown_ratio  parameters { ratio_worth "7.2 m" } }
#pragma once
#include <boost/property_tree/ptree.hpp>
#include <string>

namespace karst::selection {

struct PolicyPreset {
  std::string policy;
  boost::property_tree::ptree parameters;
};

/// Throws InputError with file and key; also if the file sets anything but a policy.
PolicyPreset read_preset(const std::string& file);
/// `remark`: the origin of the preset, one or more lines.
std::string to_info(const PolicyPreset& preset, const std::string& remark);

}  // namespace karst::selection
