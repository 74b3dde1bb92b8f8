// How paths become motion: by the paper's sampling (trajectory.h), as minimum-snap polynomials
// (polynomial_trajectory.h), or sampled and replanned with a receding horizon while exploring
// (horizon/horizon_planner.h). `automatic`: by what the vehicle sees with.
#pragma once
#include "core_stack/common/enum_names.h"

namespace karst::core {

enum class TrajectoryKind { automatic, sampled, polynomial, horizon };
constexpr auto names_of(TrajectoryKind) {
  using enum TrajectoryKind;
  return std::to_array<Named<TrajectoryKind>>(
      {{automatic, "auto"}, {sampled, "sampled"}, {polynomial, "polynomial"}, {horizon, "horizon"}});
}

}  // namespace karst::core
