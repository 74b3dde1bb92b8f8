// Results of a campaign so far, as read from the store and used by statistics, reports, tuning and selection.
// Only the store uses SQL.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace karst::campaign {

struct ContestantEntry {
  std::string name, policy, version;
  std::string parameters;  // JSON object: resolved values of the policy's parameters
  std::string settings;    // JSON object: mission settings of this contestant alone
};

struct CaveEntry {
  std::string name, file, start;
  std::string description;  // JSON object of sdk/selection's figures; empty if not described yet
  std::string hash;         // SHA-256 of the mesh's bytes
};

struct CurvePoint {
  double time_s = 0;  // from take-off
  double explored_m3 = 0, coverage = 0;
};

struct TrialResult {
  std::size_t contestant = 0, cave = 0;  // indices into the vectors below
  std::int64_t seed = 0;
  bool failed = false;          // it crashed, hung or could not start
  std::string outcome, reason;  // as in metrics.json; for a failed trial the cause
  std::string run_dir;          // absolute
  std::vector<double> figures;  // in the order of evaluation::metric_definitions(); NaN: not known
  std::vector<CurvePoint> curve;
  std::string ended = {};  // evaluation::Ending::sentence; "" if it failed, or an earlier karst stored it
};

struct CampaignResults {
  std::string name;
  double horizon_s = 0;  // the longest possible exploration; the limit of restricted times
  std::vector<ContestantEntry> contestants;
  std::vector<CaveEntry> caves;
  std::vector<TrialResult> trials;      // by contestant, cave, seed
  std::string metric = "coverage_auc";  // decides the verdict, as declared before the first flight
  std::string profile = {};             // sdk/campaign/plan/profile.h; "" if unknown
  // Keys and values of the resolved mission shared by the contestants without settings of their own: all
  // except policy, flight time and cave.
  std::vector<std::pair<std::string, std::string>> shared = {};
  std::string flight_time = {};  // mission.max_flight_time with its unit; "" if unknown
};

/// Reads profile, metric, flight time and shared settings from a campaign's definition. `source` names the
/// store in errors. Throws core::InputError if the text is not a definition.
void read_conditions(const std::string& definition, const std::string& source, CampaignResults& results);

}  // namespace karst::campaign
