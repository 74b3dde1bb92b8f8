// The safety supervisor: from what is wrong to what is done about it, ten times a second.
//
// Each rule reads one observation. Two questions are answered apart, so that neither answer hides the other:
// what is done about the motion, where the most severe action of all rules counts, and whether exploring has
// to end. An action is kept for a second after its cause is gone, so that it does not flicker.
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
  std::optional<double> hull_clearance_m;  // to the surface of the nearest obstacle in the map, if it is near
  double blind_s = 0;                      // since the last scan or image was taken into the map
  double battery_s = 0;                    // left
};

struct SafetyVerdict {
  SafetyAction action = SafetyAction::none;
  std::string reason;                       // of the action
  std::optional<std::string> go_home = {};  // why exploring has to end, if it has
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
