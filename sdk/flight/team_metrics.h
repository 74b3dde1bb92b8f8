// The figures of a team's run, as its metrics.json holds them. Definitions: docs/metrics.md.
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

/// Sets the sums over the robots that are null.
void add_sums(nlohmann::ordered_json& metrics, const std::vector<nlohmann::json>& robots);

/// What is known of any flight: sums over the `robots`, and null for all other figures.
nlohmann::ordered_json begin_team_metrics(const TeamFlightFacts& flight,
                                          const std::vector<nlohmann::json>& robots);

/// `robots` are the metrics of each robot's own run. Figures of one flight are null but for sums over the
/// robots; a robot's own are below `robots`.
nlohmann::ordered_json team_metrics(const Mission& mission, const TeamResult& result,
                                    const std::vector<nlohmann::json>& robots);

}  // namespace karst::flight
