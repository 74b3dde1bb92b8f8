// Faults that a simulated flight injects into its team, to test the others' reaction: keys of the mission
// file's section `team`. The core stacks do not know of them.
#pragma once
#include <string>

#include "core_stack/common/options.h"

namespace karst::flight {

/// The numbers of the affected robots; 0: none.
struct TeamFaults {
  std::int64_t lost_robot = 0, silent_relay = 0;
  double lost_after_s = 60, silent_after_s = 30;
};
void describe(core::OptionTable& t, TeamFaults& faults);

/// Throws core::InputError naming `source` if a fault is set for a robot that the team does not have.
void check(const TeamFaults& faults, std::int64_t robots, const std::string& source);

}  // namespace karst::flight
