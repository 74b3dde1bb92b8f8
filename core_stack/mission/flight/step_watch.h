// Detects a periodic step that has stopped; queried by steps that still run.
#pragma once
#include "core_stack/common/time.h"

namespace karst::core {

class StepWatch {
 public:
  /// `patience`: a few periods of the step.
  explicit StepWatch(TimeNs patience) : patience_(patience) {}
  void came(TimeNs now) { last_ = now; }
  TimeNs since(TimeNs now) const { return now - last_; }
  bool missing(TimeNs now) const { return since(now) > patience_; }

 private:
  TimeNs patience_;
  TimeNs last_ = 0;
};

}  // namespace karst::core
