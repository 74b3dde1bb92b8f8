// What set the speed of a vehicle while it explored, and for how long.
#pragma once
#include <array>
#include <limits>

#include "core_stack/planning/trajectory/speed_by_trust.h"
#include "sdk/evaluation/record/run_record.h"

namespace karst::evaluation {

struct SpeedLimitTime {
  double time_s = 0, path_m = 0;  // path of the reference
};

struct SpeedLimitTimes {
  std::array<SpeedLimitTime, names_of(core::SpeedLimit{}).size()> of;
  SpeedLimitTime& operator[](core::SpeedLimit limit) { return of[static_cast<std::size_t>(limit)]; }
  const SpeedLimitTime& operator[](core::SpeedLimit limit) const {
    return of[static_cast<std::size_t>(limit)];
  }
  double total_s() const;
};

/// Until `until_s` of the run's time. All zero if the run's events do not tell: missions of up to 2 m/s.
SpeedLimitTimes speed_limit_times(const RunRecord& run,
                                  double until_s = std::numeric_limits<double>::infinity());

/// In plain words.
const char* words_for(core::SpeedLimit limit);

}  // namespace karst::evaluation
