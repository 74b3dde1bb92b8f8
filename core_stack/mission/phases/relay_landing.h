// Chooses and claims the site where a robot lands as a relay, and confirms it once the robot hovers there.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "core_stack/mission/onboard/onboard.h"
#include "core_stack/mission/phases/endurance.h"
#include "core_stack/mission/state/phase.h"
#include "core_stack/team/teamwork.h"

namespace karst::core {

class RelayLanding {
 public:
  RelayLanding(Onboard& onboard, Teamwork& team, const PhaseMachine& phases, const Endurance& endurance)
      : onboard_(onboard), team_(team), phases_(phases), endurance_(endurance) {}

  /// Without a site the robot lands at its start.
  const std::optional<LandingSpot>& spot() const { return spot_; }
  /// Looks for a site; there is none if the start can be reached sooner. Calls `over` when the choice is
  /// made, and then `changed` if the site differs from the previous one.
  void choose(double flown_length_m, std::function<void()> over, std::function<void()> changed);
  /// Whether it is time to look for another site, since it would arrive too late at this one.
  bool look_again_due() const { return look_again_ && onboard_.now() >= *look_again_; }
  /// Whether another robot claimed the site earlier.
  bool overruled() const { return spot_ && team_.overruled(); }

  enum class Heard { waits, lands, nobody };
  /// Call while hovering at the site: radio contact decides whether to land. Sets `why` if it lands.
  Heard listen(std::string& why);
  /// Call when it no longer hovers there.
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
  std::optional<TimeNs> unheard_since_;  // since when it hovers there without contact to the base
};

}  // namespace karst::core
