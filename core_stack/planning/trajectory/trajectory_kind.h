// How paths become motion: by the paper's sampling (trajectory.h), as minimum-snap polynomials
// (polynomial_trajectory.h), or sampled and replanned with a receding horizon while exploring
// (horizon/horizon_planner.h).
#pragma once
#include "core_stack/common/enum_names.h"

namespace karst::core {

enum class TrajectoryKind { sampled, polynomial, horizon };
constexpr auto names_of(TrajectoryKind) {
  using enum TrajectoryKind;
  return std::to_array<Named<TrajectoryKind>>(
      {{sampled, "sampled"}, {polynomial, "polynomial"}, {horizon, "horizon"}});
}

}  // namespace karst::core
