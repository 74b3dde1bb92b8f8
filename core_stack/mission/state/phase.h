// The phases of a mission and the transitions between them.
#pragma once
#include <optional>
#include <span>

#include "core_stack/common/enum_names.h"
#include "core_stack/common/time.h"

namespace karst::core {

enum class Phase {
  standby,
  takeoff,
  look,
  explore,
  home,
  land,
  manual,  // the pilot or the autopilot steers
  done,
  replay  // all of a recording
};
constexpr auto names_of(Phase) {
  using enum Phase;
  return std::to_array<Named<Phase>>({{standby, "standby"},
                                      {takeoff, "takeoff"},
                                      {look, "look"},
                                      {explore, "explore"},
                                      {home, "home"},
                                      {land, "land"},
                                      {manual, "manual"},
                                      {done, "done"},
                                      {replay, "replay"}});
}

/// What holds of the vehicle in a phase. Code that depends on the phase asks for these, not for phases by
/// name.
struct PhaseTraits {
  bool airborne = false;      // from lift-off to touch-down
  bool above_ground = false;  // airborne, and not on its way up from the ground or down to it
  bool flies_by_map = false;  // it stops for obstacles ahead, and separation rules apply to it
  bool explores = false;      // it may be sent home
};
constexpr PhaseTraits traits_of(Phase phase) {
  switch (phase) {  // without a default: the compiler names a phase that is left out
    case Phase::takeoff:
    case Phase::land:
      return {.airborne = true};
    case Phase::look:
    case Phase::manual:
      return {.airborne = true, .above_ground = true};
    case Phase::explore:
      return {.airborne = true, .above_ground = true, .flies_by_map = true, .explores = true};
    case Phase::home:
      return {.airborne = true, .above_ground = true, .flies_by_map = true};
    case Phase::standby:
    case Phase::done:
    case Phase::replay:
      break;
  }
  return {};
}

struct Transition {
  std::optional<Phase> from;  // nothing: any phase
  Phase to;
  const char* when;
};

/// The transition table.
std::span<const Transition> transitions();

class PhaseMachine {
 public:
  Phase phase() const { return phase_; }
  bool in(Phase phase) const { return phase_ == phase; }
  /// Whether it flies by its map.
  bool under_way() const { return traits_of(phase_).flies_by_map; }
  bool explores() const { return traits_of(phase_).explores; }
  /// When the phase began.
  TimeNs since() const { return since_; }
  /// Throws std::logic_error if there is no such transition.
  void enter(Phase to, TimeNs now);

 private:
  Phase phase_ = Phase::standby;
  TimeNs since_ = 0;
};

}  // namespace karst::core
