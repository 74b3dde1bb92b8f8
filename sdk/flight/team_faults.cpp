#include "sdk/flight/team_faults.h"

#include <utility>

#include "core_stack/common/error.h"
#include "core_stack/team/communication/messages.h"

namespace karst::flight {

void describe(core::OptionTable& t, TeamFaults& f) {
  t.add("lost_robot", f.lost_robot, 0, core::kMaxRobots - 1,
        "for tests: the number of a robot that never comes back");
  t.add("lost_after", f.lost_after_s, "s", 0, 7200,
        "from its start: then it is lost, if it is in the air by then");
  t.add("silent_relay", f.silent_relay, 0, core::kMaxRobots - 1,
        "for tests: the number of a robot whose radio fails");
  t.add("silent_after", f.silent_after_s, "s", 0, 7200, "behind its landing: then it is silent");
}

void check(const TeamFaults& faults, std::int64_t robots, const std::string& source) {
  for (const auto& [key, robot] : {std::pair{"team.lost_robot", faults.lost_robot},
                                   std::pair{"team.silent_relay", faults.silent_relay}}) {
    if (robot > 0 && robots == 1)
      throw core::InputError(source, key, "a vehicle alone is no team: team.robots is 1");
    if (robot > robots)
      throw core::InputError(
          source, key,
          "there is no robot " + std::to_string(robot) + ": team.robots is " + std::to_string(robots));
  }
}

}  // namespace karst::flight
