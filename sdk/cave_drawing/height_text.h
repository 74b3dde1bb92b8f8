// A height relative to the entrance, as cavers note it.
#pragma once
#include <cmath>
#include <string>

#include "core_stack/common/format_text.h"

namespace karst::cave_drawing {

/// "+3", "−12", "0".
inline std::string height_text(double height_m) {
  const double whole = std::round(height_m);
  if (whole == 0) return "0";
  return (whole > 0 ? "+" : "\u2212") + core::format_text("%.0f", std::abs(whole));
}

}  // namespace karst::cave_drawing
