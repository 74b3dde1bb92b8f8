#include "sdk/evaluation/team/team_metrics.h"

namespace karst::evaluation {

nlohmann::ordered_json team_map_figures(const TeamRecord& team, const Truth& truth) {
  const nlohmann::ordered_json all = evaluate(team.merged, team.map ? &*team.map : nullptr, truth);
  nlohmann::ordered_json out;
  for (const char* key : {"explored_volume_m3", "horizon_s"}) out[key] = all[key];
  for (const char* key : kCaveFigures) out[key] = all[key];
  return out;
}

}  // namespace karst::evaluation
