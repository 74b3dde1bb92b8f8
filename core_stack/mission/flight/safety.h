// The safety supervisor: maps observations to actions, ten times a second.
//
// Each rule reads one observation. Two questions are answered separately, so that neither answer hides the
// other: the action on the motion (the most severe action of all rules applies), and whether exploration must
// end. An action is kept for a second after its cause is gone, so that it does not flicker.
#pragma once
#include <optional>
#include <string>

#include "core_stack/common/time.h"
#include "core_stack/localization/estimator.h"
#include "core_stack/mission/options/safety_options.h"
#include "core_stack/mission/state/safety_action.h"

namespace karst::core {

struct SafetyObservation {
  TimeNs now = 0;
  Diagnosis estimate;
  double tracking_error_m = 0;
  std::optional<double> hull_clearance_m;  // to the nearest obstacle's surface in the map, if one is near
  double blind_s = 0;                      // since the last scan or image was inserted into the map
  double battery_s = 0;                    // remaining
  std::string outside = {};                // of which part of its region the hull is; "": inside
};

struct SafetyVerdict {
  SafetyAction action = SafetyAction::none;
  std::string reason;                       // for the action
  std::optional<std::string> go_home = {};  // why exploration must end, if it must
  bool same_motion(const SafetyVerdict& o) const { return action == o.action && reason == o.reason; }
};

class SafetySupervisor {
 public:
  explicit SafetySupervisor(const SafetyOptions& options) : options_(options) {}
  const SafetyVerdict& judge(const SafetyObservation& o);

 private:
  SafetyVerdict on_motion(const SafetyObservation& o) const;
  std::optional<std::string> why_home(const SafetyObservation& o) const;

  SafetyOptions options_;
  SafetyVerdict verdict_;
  TimeNs cause_seen_ = 0;
  std::optional<TimeNs> degraded_since_;
};

}  // namespace karst::core
