// Where a robot of a team lands as a relay: the place it chooses, claims, and once it hovers there, confirms.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "core_stack/mission/onboard/onboard.h"
#include "core_stack/mission/phases/endurance.h"
#include "core_stack/mission/phases/phase.h"
#include "core_stack/team/teamwork.h"

namespace karst::core {

class RelayLanding {
 public:
  RelayLanding(Onboard& onboard, Teamwork& team, const PhaseMachine& phases, const Endurance& endurance)
      : onboard_(onboard), team_(team), phases_(phases), endurance_(endurance) {}

  /// Without one it lands at its start.
  const std::optional<LandingSpot>& spot() const { return spot_; }
  /// Looks for a place; if the start is nearer in time, there is none. `over` is called when the choice is
  /// made, and then `changed` if it leads elsewhere than the one before.
  void choose(double flown_length_m, std::function<void()> over, std::function<void()> changed);
  /// It comes too late to the place that it flies to: time to look for another.
  bool look_again_due() const { return look_again_ && onboard_.now() >= *look_again_; }
  /// Another robot claimed it before.
  bool overruled() const { return spot_ && team_.overruled(); }

  enum class Heard { waits, lands, nobody };
  /// Asked while it hovers there: what is heard decides whether to land, and `why` it does.
  Heard listen(std::string& why);
  /// It does not hover there any more.
  void stop_listening() { unheard_since_.reset(); }

  enum class Because { not_to_be_had, no_contact };
  void give_up(const std::string& reason, Because because);

 private:
  void on_choice(const std::optional<LandingSpot>& before, const std::function<void()>& changed);

  Onboard& onboard_;
  Teamwork& team_;
  const PhaseMachine& phases_;
  const Endurance& endurance_;
  std::optional<LandingSpot> spot_;
  std::optional<TimeNs> look_again_;
  std::optional<TimeNs> unheard_since_;  // it hovers there and hears nobody who reaches the base
};

}  // namespace karst::core
