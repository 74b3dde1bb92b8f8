#include "sdk/evaluation/metrics/unsurveyed.h"

#include <algorithm>
#include <cmath>

#include "sdk/evaluation/metrics/flight_figures.h"

namespace karst::evaluation {

std::optional<UnsurveyedFigures> unsurveyed_figures(const RunRecord& run) {
  constexpr double kEnough_m3 = 50;
  const auto* t_s = run.unsurveyed.times();
  const auto* volume_m3 = run.unsurveyed.column("unsurveyed_m3");
  const auto last = last_finite(volume_m3);
  if (!t_s || !last) return std::nullopt;
  UnsurveyedFigures figures{*last, std::nullopt};
  const double begin_s = flight_begin_s(run);
  for (std::size_t i = 0; i < t_s->size() && !figures.time_to_50_s; ++i)
    if (std::isfinite((*t_s)[i]) && (*volume_m3)[i] >= kEnough_m3)
      figures.time_to_50_s = std::max(0.0, (*t_s)[i] - begin_s);
  return figures;
}

}  // namespace karst::evaluation
