// Which filter of the bank is believed (estimator.h).
#pragma once
#include "core_stack/common/enum_names.h"

namespace karst::core {

enum class Hypothesis { lidar, magnetic };
constexpr auto names_of(Hypothesis) {
  using enum Hypothesis;
  return std::to_array<Named<Hypothesis>>({{lidar, "lidar"}, {magnetic, "magnetic"}});
}

}  // namespace karst::core
