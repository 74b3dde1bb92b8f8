// A policy with its parameters as a file of its own: what `karst tune` and `karst select` write, `karst fly
// --preset` takes, and a mission file without a policy section of its own can include.
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

/// Throws InputError naming file and key: also if it sets anything but a policy.
PolicyPreset read_preset(const std::string& file);
/// `remark`: where it comes from, one line or several.
std::string to_info(const PolicyPreset& preset, const std::string& remark);

}  // namespace karst::selection
