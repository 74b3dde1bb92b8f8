// Text of numbers and places with a fixed number of decimals. What rounds to zero has no sign: "0.0".
#pragma once
#include <string>

#include "core_stack/common/format_text.h"
#include "core_stack/common/geometry.h"

namespace karst::core {

inline std::string decimal_text(double v, int decimals) {
  std::string text = format_text("%.*f", decimals, v);
  if (text.starts_with('-') && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

/// "1.0 2.0 -0.5"
inline std::string decimal_text(const Vec3& place, int decimals) {
  return decimal_text(place.x(), decimals) + " " + decimal_text(place.y(), decimals) + " " +
         decimal_text(place.z(), decimals);
}

}  // namespace karst::core
