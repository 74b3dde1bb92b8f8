// What a simulated flight does to its team, to see what the others make of it: keys of the mission file's
// section `team`. What flies knows nothing of them.
#pragma once
#include <string>

#include "core_stack/common/options.h"

namespace karst::flight {

/// Robots by number; 0: none.
struct TeamFaults {
  std::int64_t lost_robot = 0, silent_relay = 0;
  double lost_after_s = 60, silent_after_s = 30;
};
void describe(core::OptionTable& t, TeamFaults& faults);

/// Throws core::InputError naming `source` if a fault is to befall a robot that the team does not have.
void check(const TeamFaults& faults, std::int64_t robots, const std::string& source);

}  // namespace karst::flight
