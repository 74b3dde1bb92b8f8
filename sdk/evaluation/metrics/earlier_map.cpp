#include "sdk/evaluation/metrics/earlier_map.h"

namespace karst::evaluation {

std::optional<EarlierMapFigures> earlier_map_figures(const RunRecord& run) {
  const auto last = run.last<core::event::EarlierMap>();
  if (!last) return std::nullopt;
  const bool found = last->state == core::event::EarlierMapState::found;
  return EarlierMapFigures{found, found ? last->free_m3 : std::nullopt};
}

}  // namespace karst::evaluation
