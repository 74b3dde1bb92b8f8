// Legs by their stations.
#pragma once
#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "sdk/survey/survey.h"

namespace karst::survey {

class LegLookup {
 public:
  explicit LegLookup(const Survey& survey) {
    for (std::uint32_t i = 0; i < survey.legs.size(); ++i)
      legs_.emplace(std::minmax(survey.legs[i].from, survey.legs[i].to), i);
  }
  /// The first leg that joins them, in either direction.
  std::optional<std::uint32_t> between(std::uint32_t a, std::uint32_t b) const {
    const auto it = legs_.find(std::minmax(a, b));
    return it == legs_.end() ? std::nullopt : std::optional(it->second);
  }

 private:
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> legs_;
};

}  // namespace karst::survey
