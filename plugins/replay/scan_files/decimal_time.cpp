#include "plugins/replay/scan_files/decimal_time.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "plugins/replay/scan_files/text_numbers.h"

namespace karst::replay {

using core::TimeNs;

std::optional<TimeNs> parse_time(std::string_view text, TimeNs unit_ns) {
  double rough = 0;
  if (!to_number(text, rough) || !std::isfinite(rough)) return std::nullopt;
  if (std::abs(rough) * static_cast<double>(unit_ns) >= 9.2e18) return std::nullopt;
  if (text.find_first_not_of("+-.0123456789") != std::string_view::npos)
    return static_cast<TimeNs>(std::llround(rough * static_cast<double>(unit_ns)));
  const bool negative = text.starts_with('-');
  TimeNs whole = 0, part = 0, weight = unit_ns;
  bool after_point = false;
  for (const char c : text) {
    if (c == '.') after_point = true;
    if (c < '0' || c > '9') continue;
    if (!after_point) {
      whole = 10 * whole + (c - '0');
    } else if (weight % 10 == 0) {
      weight /= 10;
      part += weight * (c - '0');
    }
  }
  const TimeNs t = whole * unit_ns + part;
  return negative ? -t : t;
}

std::string decimal_seconds(TimeNs t) {
  const TimeNs magnitude = t < 0 ? -t : t;
  std::array<char, 40> text;
  std::snprintf(text.data(), text.size(), "%s%lld.%09lld", t < 0 ? "-" : "",
                static_cast<long long>(magnitude / core::kSecond),
                static_cast<long long>(magnitude % core::kSecond));
  return text.data();
}

}  // namespace karst::replay
