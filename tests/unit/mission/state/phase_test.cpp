#include "core_stack/mission/state/phase.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <stdexcept>
#include <vector>

namespace karst::core {
namespace {

constexpr Phase kAll[] = {Phase::standby, Phase::takeoff, Phase::look,   Phase::explore,
                          Phase::home,    Phase::land,    Phase::manual, Phase::done};

TEST(PhaseMachine, GoesFromPhaseToPhaseAsTheMissionDoesAndNoOtherWay) {
  const std::set<std::pair<Phase, Phase>> allowed{
      {Phase::standby, Phase::takeoff}, {Phase::takeoff, Phase::look},   {Phase::takeoff, Phase::explore},
      {Phase::look, Phase::explore},    {Phase::explore, Phase::home},   {Phase::land, Phase::home},
      {Phase::manual, Phase::standby},  {Phase::manual, Phase::look},    {Phase::manual, Phase::explore},
      {Phase::manual, Phase::home},     {Phase::standby, Phase::standby}};
  const std::map<Phase, std::vector<Phase>> path_there{
      {Phase::standby, {}},
      {Phase::takeoff, {Phase::takeoff}},
      {Phase::look, {Phase::takeoff, Phase::look}},
      {Phase::explore, {Phase::takeoff, Phase::explore}},
      {Phase::home, {Phase::takeoff, Phase::explore, Phase::home}},
      {Phase::land, {Phase::land}},
      {Phase::manual, {Phase::manual}},
      {Phase::done, {Phase::done}}};
  for (const Phase from : kAll) {
    for (const Phase to : kAll) {
      PhaseMachine m;
      for (const Phase p : path_there.at(from)) m.enter(p, 1);
      const bool always = to == Phase::land || to == Phase::manual || to == Phase::done;
      if (always || allowed.contains({from, to})) {
        EXPECT_NO_THROW(m.enter(to, 7)) << name_of(from) << " -> " << name_of(to);
        EXPECT_TRUE(m.in(to));
        EXPECT_EQ(m.since(), 7);
      } else {
        EXPECT_THROW(m.enter(to, 7), std::logic_error) << name_of(from) << " -> " << name_of(to);
        EXPECT_TRUE(m.in(from)) << "a refused transition changes nothing";
      }
    }
  }
}

TEST(PhaseMachine, EveryPhaseCanBeReachedAndSaysWhen) {
  std::set<Phase> reached;
  for (const Transition& t : transitions()) {
    EXPECT_STRNE(t.when, "");
    reached.insert(t.to);
  }
  EXPECT_EQ(reached.size(), std::size(kAll));
}

}  // namespace
}  // namespace karst::core
