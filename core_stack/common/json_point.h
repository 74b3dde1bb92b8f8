// Points as the lists of numbers that events and logs hold.
#pragma once
#include <nlohmann/json.hpp>
#include <vector>

#include "core_stack/common/geometry.h"
#include "core_stack/common/rounded.h"

namespace karst::core {

/// Zero has no sign, as in rounded().
inline nlohmann::json list(const Vec3& p) { return {p.x() + 0.0, p.y() + 0.0, p.z() + 0.0}; }

inline nlohmann::json list(const std::vector<Vec3>& points) {
  nlohmann::json all = nlohmann::json::array();
  for (const Vec3& p : points) all.push_back(list(p));
  return all;
}

/// To thousandths: a log needs no more, and is half as long.
inline nlohmann::json rounded_list(const Vec3& p) {
  return {to_thousandths(p.x()), to_thousandths(p.y()), to_thousandths(p.z())};
}

}  // namespace karst::core
