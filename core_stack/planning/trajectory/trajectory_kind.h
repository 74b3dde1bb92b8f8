// How paths become motion: by the paper's sampling (trajectory.h), or as minimum-snap polynomials
// (polynomial_trajectory.h).
#pragma once
#include "core_stack/common/enum_names.h"

namespace karst::core {

enum class TrajectoryKind { sampled, polynomial };
constexpr auto names_of(TrajectoryKind) {
  using enum TrajectoryKind;
  return std::to_array<Named<TrajectoryKind>>({{sampled, "sampled"}, {polynomial, "polynomial"}});
}

}  // namespace karst::core
