#include "sdk/selection/preset.h"

#include <boost/property_tree/info_parser.hpp>
#include <sstream>

#include "core_stack/common/error.h"
#include "core_stack/common/options.h"

namespace karst::selection {

using boost::property_tree::ptree;
using core::InputError;

PolicyPreset read_preset(const std::string& file) {
  const ptree tree = core::read_info(file);
  for (const auto& [key, child] : tree)
    if (key != "policy") throw InputError(file, key, "a preset sets a policy and nothing else");
  if (tree.count("policy") != 1)
    throw InputError(file, "policy", "expected one block policy { name ... parameters { ... } }");
  PolicyPreset preset;
  for (const auto& [key, child] : tree.get_child("policy")) {
    if (key == "name" && preset.policy.empty())
      preset.policy = child.data();
    else if (key == "parameters" && preset.parameters.empty())
      preset.parameters = child;
    else
      throw InputError(file, "policy." + key, "expected one name, and one block of parameters at most");
  }
  if (preset.policy.empty()) throw InputError(file, "policy.name", "is missing");
  return preset;
}

std::string to_info(const PolicyPreset& preset, const std::string& remark) {
  std::ostringstream out;
  std::istringstream lines(remark);
  for (std::string line; std::getline(lines, line);) out << "; " << line << "\n";
  ptree tree;
  tree.put("policy.name", preset.policy);
  if (!preset.parameters.empty()) tree.put_child("policy.parameters", preset.parameters);
  boost::property_tree::write_info(out, tree);
  return out.str();
}

}  // namespace karst::selection
