// How a flight ended and why its exploration did, in a sentence for people.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "sdk/evaluation/metrics/policy_restart.h"
#include "sdk/evaluation/record/run_record.h"

namespace karst::evaluation {

/// A policy that failed in flight, so that the fallback took over.
struct FailedPolicy {
  double time_s = 0;  // of the record
  std::string why;
};

/// Decisions that the policy gave no answer to, because of an exception for example. The vehicle held its
/// course.
struct LostDecisions {
  std::size_t count = 0;
  std::string last;  // what was wrong, and at which request
};

struct Ending {
  /// Whether the mission went as planned: like completed(), but a landing as a relay counts, too, and so does
  /// a recording that was replayed to its end.
  bool as_meant = false;
  /// "home because nothing was left to explore; 62 % battery left", "home after 4 s: the pose was lost".
  /// Times count from take-off. Empty: the record has no events.
  std::string sentence;
  std::optional<FailedPolicy> failed_policy = {};
  std::optional<PolicyRestart> restart = {};  // the policy's, after a crash and the like
  LostDecisions lost_decisions = {};
};

/// The key of mission.info with the time that is kept for after the way home.
inline constexpr const char* kHomeReserveKey = "mission.home_reserve";

/// The figures of a run that say more than its events; empty where they are not known.
struct EndFigures {
  std::optional<double> landing_error_m, battery_left;  // as in FlightFigures
  std::optional<double> home_reserve_s = {};            // mission.home_reserve
};

Ending ending_of(const RunRecord& run, const EndFigures& figures);
/// With the figures from the record itself.
Ending ending_of(const RunRecord& run);

/// Of a team whose robots ended so: as planned if each was, or else the robots that were not, by number; and
/// the robots whose policies broke.
Ending joint_ending(const std::vector<Ending>& robots);

}  // namespace karst::evaluation
