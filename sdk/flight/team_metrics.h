// The metrics of a team's run, as stored in its metrics.json. Definitions: docs/metrics.md.
#pragma once
#include <nlohmann/json.hpp>

#include "sdk/flight/mission_file.h"
#include "sdk/flight/team_flight.h"

namespace karst::flight {

struct TeamFlightFacts {
  std::string policy, cave;
  std::int64_t seed = 0;
  core::MissionOutcome outcome = core::MissionOutcome::incomplete;
  std::string reason;
};

/// Fills in those sums over the robots that are still null.
void add_sums(nlohmann::ordered_json& metrics, const std::vector<nlohmann::json>& robots);

/// The metrics known for any flight: sums over the `robots`, and null for all others.
nlohmann::ordered_json begin_team_metrics(const TeamFlightFacts& flight,
                                          const std::vector<nlohmann::json>& robots);

/// `robots` are the metrics of each robot's own run. Metrics of a single flight are null except for sums over
/// the robots; each robot's own are in the key `robots`.
nlohmann::ordered_json team_metrics(const Mission& mission, const TeamResult& result,
                                    const std::vector<nlohmann::json>& robots);

}  // namespace karst::flight
