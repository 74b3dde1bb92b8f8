// Times as text, parsed without rounding: seconds since 1970 have more digits than a double.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "core_stack/common/time.h"

namespace karst::replay {

/// Nanoseconds in a unit: "s", "ms", "us" or "ns".
constexpr core::TimeNs nanoseconds_of(std::string_view unit) {
  return unit == "s" ? 1'000'000'000 : unit == "ms" ? 1'000'000 : unit == "us" ? 1000 : 1;
}

/// Converts "1647090478.710633039" in `unit` to nanoseconds and truncates further digits; also "1.6e9", which
/// may round. nullopt if the text is no number, or does not fit 64 bits of nanoseconds.
std::optional<core::TimeNs> parse_time(std::string_view text, core::TimeNs unit_ns);

/// "1647090478.710633039": seconds with nine decimals.
std::string decimal_seconds(core::TimeNs t);

}  // namespace karst::replay
