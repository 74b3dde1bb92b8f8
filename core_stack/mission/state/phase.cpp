#include "core_stack/mission/state/phase.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

namespace karst::core {
namespace {

constexpr std::array kTransitions{
    Transition{Phase::standby, Phase::takeoff, "the estimate has settled, and no vehicle is near the hover"},
    Transition{Phase::takeoff, Phase::look,
               "it hovers, and its cameras see one side only, or it looks for its place in an earlier map"},
    Transition{Phase::takeoff, Phase::explore, "it hovers, and its LiDAR sees all around"},
    Transition{Phase::look, Phase::explore,
               "it has turned around once, or knows whether it has a place in the earlier map"},
    Transition{
        Phase::explore, Phase::home,
        "nothing is left to explore, the policy or the safety supervisor asks for it, the time left only "
        "just suffices, or the record cannot be written"},
    Transition{Phase::home, Phase::land, "it hovers where it lands, or no way leads there"},
    Transition{Phase::land, Phase::home, "the pose is known again, for want of which it came down"},
    Transition{{}, Phase::manual, "the pilot or the autopilot steers"},
    Transition{Phase::manual, Phase::standby, "the pilot has set it down again before the first hand-over"},
    Transition{Phase::manual, Phase::look,
               "the core steers again, and its cameras have not looked around yet"},
    Transition{Phase::manual, Phase::explore, "the core steers again, and had not turned back"},
    Transition{Phase::manual, Phase::home, "the core steers again, and had turned back"},
    Transition{Phase::manual, Phase::land, "the core steers again, above where it was landing"},
    Transition{{}, Phase::land, "the safety supervisor, an error or the operator ends the flight"},
    Transition{{}, Phase::done, "it stands, or is lost"},
};

}  // namespace

std::span<const Transition> transitions() { return kTransitions; }

void PhaseMachine::enter(Phase to, TimeNs now) {
  const bool begins =
      in(Phase::standby) && to == Phase::standby;  // the first phase is recorded like the others
  const bool follows = std::any_of(kTransitions.begin(), kTransitions.end(), [&](const Transition& t) {
    return t.to == to && (!t.from || *t.from == phase_);
  });
  if (!begins && !follows)
    throw std::logic_error(std::string("phase ") + name_of(to) + " does not follow " + name_of(phase_));
  phase_ = to;
  since_ = now;
}

}  // namespace karst::core
