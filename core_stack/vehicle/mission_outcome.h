// How a mission ended.
#pragma once
#include "core_stack/common/enum_names.h"

namespace karst::core {

enum class MissionOutcome {
  landed,      // where it should: at the start, or as a relay
  contact,     // it touched rock, the ground or another vehicle
  stuck,       // on the ground elsewhere
  battery,     // empty in the air
  lost,        // given up by whoever runs the flight
  aborted,     // by an emergency, an error or the operator
  replayed,    // of a recording: all of it
  incomplete,  // of a team: not all landed
};
constexpr auto names_of(MissionOutcome) {
  using enum MissionOutcome;
  return std::to_array<Named<MissionOutcome>>({{landed, "landed"},
                                               {contact, "contact"},
                                               {stuck, "stuck"},
                                               {battery, "battery"},
                                               {lost, "lost"},
                                               {aborted, "aborted"},
                                               {replayed, "replayed"},
                                               {incomplete, "incomplete"}});
}

}  // namespace karst::core
