// Points as the lists of numbers that events and logs hold.
#pragma once
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "core_stack/common/geometry.h"

namespace karst::core {

inline nlohmann::json list(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

inline nlohmann::json list(const std::vector<Vec3>& points) {
  nlohmann::json all = nlohmann::json::array();
  for (const Vec3& p : points) all.push_back(list(p));
  return all;
}

/// To thousandths: a log needs no more, and is half as long.
inline double rounded(double v) { return std::round(v * 1000) / 1000; }
inline nlohmann::json rounded_list(const Vec3& p) { return {rounded(p.x()), rounded(p.y()), rounded(p.z())}; }

}  // namespace karst::core
