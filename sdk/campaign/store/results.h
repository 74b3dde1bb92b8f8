// What a campaign has found so far, as the store gives it and as statistics, reports, tuning and selection
// take it. Only the store knows SQL.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace karst::campaign {

struct ContestantEntry {
  std::string name, policy, version;
  std::string parameters;  // JSON object: resolved values of the policy's parameters
  std::string settings;    // JSON object: other mission settings of this contestant alone
};

struct CaveEntry {
  std::string name, file, start;
  std::string description;  // JSON object of sdk/selection's figures; empty if it was not described
  std::string hash;         // SHA-256 of the mesh's bytes
};

struct CurvePoint {
  double time_s = 0;  // from take-off
  double explored_m3 = 0, coverage = 0;
};

struct TrialResult {
  std::size_t contestant = 0, cave = 0;  // indices below
  std::int64_t seed = 0;
  bool failed = false;          // it crashed, hung or could not start
  std::string outcome, reason;  // as in metrics.json; of a failed trial why it failed
  std::string run_dir;          // absolute
  std::vector<double> figures;  // in the order of evaluation::metric_definitions(); NaN: not known
  std::vector<CurvePoint> curve;
};

struct CampaignResults {
  std::string name;
  double horizon_s = 0;  // the longest a trial's exploration could take; what restricted times are cut at
  std::vector<ContestantEntry> contestants;
  std::vector<CaveEntry> caves;
  std::vector<TrialResult> trials;      // by contestant, cave, seed
  std::string metric = "coverage_auc";  // what the verdict is about, as declared before the first flight
  std::string profile = {};             // sdk/campaign/plan/profile.h; "" if the store does not tell
  // Keys and values of the mission as resolved that the contestants without settings of their own share:
  // all but what is theirs (policy), the flight time and the cave.
  std::vector<std::pair<std::string, std::string>> shared = {};
};

/// What a campaign's definition tells of how all flew: fills what it knows of profile, metric and shared
/// settings. `source` names the store in errors. Throws core::InputError for text that is no definition.
void read_conditions(const std::string& definition, const std::string& source, CampaignResults& results);

}  // namespace karst::campaign
