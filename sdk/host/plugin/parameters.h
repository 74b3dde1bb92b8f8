// A policy's parameters: from text in a mission file to checked values in SI units.
#pragma once
#include <boost/property_tree/ptree.hpp>
#include <deque>
#include <string>
#include <variant>
#include <vector>

#include "core_stack/common/options.h"
#include "sdk/abi/karst_abi_policy.h"

namespace karst::host {

class ResolvedParameters {
 public:
  /// Throws core::InputError naming `source`, the key, what was expected, and the nearest key.
  ResolvedParameters(const karst_policy_descriptor_t& descriptor, const boost::property_tree::ptree& given,
                     const std::string& source);

  /// One value for each declared parameter, in the order of declaration; views of this object.
  std::vector<karst_parameter_value_t> values() const;
  /// All values in the format of a mission file.
  const boost::property_tree::ptree& tree() const { return tree_; }

 private:
  struct Field {
    std::string id;
    karst_parameter_type_t type;
    std::variant<double, std::int64_t, bool, std::string> value;
  };
  std::deque<Field> fields_;  // the option table points into it
  boost::property_tree::ptree tree_;
};

std::vector<std::string> split_choices(const std::string& choices);

}  // namespace karst::host
