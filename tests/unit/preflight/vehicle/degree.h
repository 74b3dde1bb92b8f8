#pragma once
#include <numbers>

namespace karst::test {

inline constexpr double kDegree = std::numbers::pi / 180;

}  // namespace karst::test
