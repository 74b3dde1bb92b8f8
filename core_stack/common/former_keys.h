// Keys of options that have been renamed, so that an old mission file is told the new name.
#pragma once
#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace karst::core {

/// The last part of a key as it was, and as it is.
inline constexpr std::array<std::pair<std::string_view, std::string_view>, 16> kFormerKeys{{
    {"degenerate_share", "degenerate_fraction"},
    {"keep_apart", "separation"},
    {"least_confidence", "min_confidence"},
    {"least_edge", "min_edge"},
    {"least_quality", "min_quality"},
    {"least_volume", "min_volume"},
    {"min_matched_share", "min_matched_fraction"},
    {"most_drop", "max_drop"},
    {"most_ratio", "max_ratio"},
    {"most_records", "max_records"},
    {"most_slope", "max_slope"},
    {"most_step", "max_step"},
    {"most_volume", "max_volume"},
    {"passage_reach", "passage_radius"},
    {"slow_share", "slow_fraction"},
    {"weak_share", "weak_fraction"},
}};

/// What `key` is called now; empty if it never had another name.
inline std::string renamed(const std::string& key) {
  const std::size_t dot = key.rfind('.'), at = dot == std::string::npos ? 0 : dot + 1;
  const auto found = std::find_if(kFormerKeys.begin(), kFormerKeys.end(),
                                  [&](const auto& k) { return k.first == key.substr(at); });
  return found == kFormerKeys.end() ? std::string() : key.substr(0, at) + std::string(found->second);
}

}  // namespace karst::core
