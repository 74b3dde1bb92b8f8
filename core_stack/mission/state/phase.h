// The phases of a mission and the transitions between them.
#pragma once
#include <optional>
#include <span>

#include "core_stack/common/enum_names.h"
#include "core_stack/common/time.h"

namespace karst::core {

enum class Phase { standby, takeoff, look, explore, home, land, done, replay };  // replay: all of a recording
constexpr auto names_of(Phase) {
  using enum Phase;
  return std::to_array<Named<Phase>>({{standby, "standby"},
                                      {takeoff, "takeoff"},
                                      {look, "look"},
                                      {explore, "explore"},
                                      {home, "home"},
                                      {land, "land"},
                                      {done, "done"},
                                      {replay, "replay"}});
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
  /// Whether the vehicle flies by its map: it stops for obstacles ahead, and separation rules apply to it.
  bool under_way() const { return in(Phase::explore) || in(Phase::home); }
  /// When the phase began.
  TimeNs since() const { return since_; }
  /// Throws std::logic_error if there is no such transition.
  void enter(Phase to, TimeNs now);

 private:
  Phase phase_ = Phase::standby;
  TimeNs since_ = 0;
};

}  // namespace karst::core
