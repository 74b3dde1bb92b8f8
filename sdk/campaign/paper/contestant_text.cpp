#include "sdk/campaign/paper/contestant_text.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core_stack/common/json_text.h"

namespace karst::campaign {
namespace {

using nlohmann::ordered_json;

/// The JSON object of a store's cell; empty if it holds none.
ordered_json object_of(const std::string& text) {
  ordered_json object = core::json_of<ordered_json>(text);
  return object.is_object() ? object : ordered_json::object();
}

std::string value_of(const ordered_json& value) {
  return value.is_string() ? value.get<std::string>() : core::json_text(value);
}

/// Whether all contestants of this one's policy have the same value of a parameter, or none.
bool is_common(const CampaignResults& results, const std::string& policy, const std::string& parameter,
               const ordered_json& value) {
  return std::all_of(results.contestants.begin(), results.contestants.end(), [&](const ContestantEntry& c) {
    if (c.policy != policy) return true;
    const ordered_json others = object_of(c.parameters);
    return others.contains(parameter) && others.at(parameter) == value;
  });
}

}  // namespace

std::string contestant_text(const CampaignResults& results, std::size_t contestant) {
  const ContestantEntry& c = results.contestants[contestant];
  std::string text = c.name + " (" + (c.policy == c.name ? "" : c.policy + " ") + c.version;
  std::string separator = "; ";
  const auto add = [&](const std::string& name, const ordered_json& value) {
    text += separator + name + " = " + value_of(value);
    separator = ", ";
  };
  const ordered_json parameters = object_of(c.parameters), settings = object_of(c.settings);
  for (const auto& [name, value] : parameters.items())
    if (!is_common(results, c.policy, name, value)) add(name, value);
  for (const auto& [name, value] : settings.items()) add(name, value);
  return text + ")";
}

}  // namespace karst::campaign
