// Time is integer nanoseconds since the mission's start: sums never round, so replays never differ.
#pragma once
#include <cmath>
#include <cstdint>

namespace karst::core {

using TimeNs = std::int64_t;

constexpr TimeNs kMillisecond = 1'000'000;
constexpr TimeNs kSecond = 1'000'000'000;

/// The nearest double: a division, because 1e-9 itself is not exact.
constexpr double seconds(TimeNs t) { return static_cast<double>(t) / 1e9; }
inline TimeNs from_seconds(double s) { return static_cast<TimeNs>(std::llround(s * 1e9)); }

}  // namespace karst::core
