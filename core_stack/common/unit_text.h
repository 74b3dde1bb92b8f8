// Units in text for people. Keys, files and metrics keep what a keyboard has: m^3.
#pragma once
#include <string>
#include <string_view>

namespace karst::core {

/// The text with m³ for each m^3.
inline std::string unit_text(std::string_view text) {
  constexpr std::string_view kCubicMetres = "m^3";
  std::string out(text);
  for (std::size_t at = out.find(kCubicMetres); at != std::string::npos; at = out.find(kCubicMetres, at))
    out.replace(at, kCubicMetres.size(), "m³");
  return out;
}

}  // namespace karst::core
