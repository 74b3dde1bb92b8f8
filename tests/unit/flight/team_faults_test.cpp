#include "sdk/flight/team_faults.h"

#include <gtest/gtest.h>

#include "core_stack/common/error.h"

namespace karst::flight {
namespace {

std::string refusal(const TeamFaults& faults, std::int64_t robots) {
  try {
    check(faults, robots, "mission.info");
  } catch (const core::InputError& e) {
    return e.what();
  }
  return "";
}

TEST(TeamFaults, BefallRobotsOfTheTeamOnly) {
  TeamFaults faults;
  EXPECT_EQ(refusal(faults, 1), "");
  faults.lost_robot = 3;
  EXPECT_EQ(refusal(faults, 3), "");
  faults.lost_robot = 4;
  for (const char* part : {"mission.info", "team.lost_robot", "4", "3"})
    EXPECT_NE(refusal(faults, 3).find(part), std::string::npos) << refusal(faults, 3);
  faults = {};
  faults.silent_relay = 1;
  EXPECT_NE(refusal(faults, 1).find("team.silent_relay"), std::string::npos) << "nobody would be silent";
}

}  // namespace
}  // namespace karst::flight
