// The phases of a mission, and which may follow which.
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
  std::optional<Phase> from;  // nothing: from any
  Phase to;
  const char* when;
};

/// All there are.
std::span<const Transition> transitions();

class PhaseMachine {
 public:
  Phase phase() const { return phase_; }
  bool in(Phase phase) const { return phase_ == phase; }
  /// It flies by its map: an obstacle ahead stops it, and others keep apart from it.
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
