#include "sdk/evaluation/team_metrics.h"

namespace karst::evaluation {

nlohmann::ordered_json team_map_figures(const TeamRecord& team, const Truth& truth) {
  const nlohmann::ordered_json all = evaluate(team.merged, team.map ? &*team.map : nullptr, truth);
  nlohmann::ordered_json out;
  for (const char* key :
       {"explored_volume_m3", "reachable_volume_m3", "coverage", "horizon_s", "coverage_auc",
        "coverage_at_25", "coverage_at_50", "coverage_at_75", "t50_s", "t90_s", "t95_s", "restricted_t50_s",
        "restricted_t90_s", "restricted_t95_s", "surface_seen", "map_error_mean_m", "map_error_std_m"})
    out[key] = all[key];
  return out;
}

}  // namespace karst::evaluation
