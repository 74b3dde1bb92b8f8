// What the scripted pilot does, and when: "2 arm, 3 hand_over, 40 take_over, 45 hand_over".
#pragma once
#include <string>
#include <vector>

#include "core_stack/common/enum_names.h"
#include "core_stack/common/time.h"

namespace karst::sim {

/// hand_over: selects offboard or guided; take_over: flies by the sticks, here a hover; hold, land: has the
/// autopilot do so.
enum class PilotAction { arm, disarm, hand_over, take_over, hold, land };
constexpr auto names_of(PilotAction) {
  using enum PilotAction;
  return std::to_array<core::Named<PilotAction>>({{arm, "arm"},
                                                  {disarm, "disarm"},
                                                  {hand_over, "hand_over"},
                                                  {take_over, "take_over"},
                                                  {hold, "hold"},
                                                  {land, "land"}});
}

struct PilotStep {
  core::TimeNs at = 0;
  PilotAction action = PilotAction::arm;
};

/// Throws InputError naming the step that cannot be read, or whose time comes before that of the last.
std::vector<PilotStep> read_pilot_script(const std::string& text);

}  // namespace karst::sim
