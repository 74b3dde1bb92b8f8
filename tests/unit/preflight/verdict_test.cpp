#include "sdk/preflight/verdict.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "tests/unit/preflight/known_mission.h"

namespace karst::preflight {
namespace {

/// The findings of a mission against which nothing speaks, but for what `change` does to it.
std::vector<Finding> findings_with(const std::function<void(Preflight&)>& change) {
  Preflight p = test::known_mission();
  change(p);
  return findings_of(p);
}

/// The only finding.
Finding only_with(const std::function<void(Preflight&)>& change) {
  const std::vector<Finding> all = findings_with(change);
  EXPECT_EQ(all.size(), 1u);
  return all.empty() ? Finding{} : all.front();
}

void expect_watch(const Finding& f, Subject subject, const std::string& part) {
  EXPECT_EQ(f.severity, Severity::watch) << f.text;
  EXPECT_EQ(f.subject, subject) << f.text;
  EXPECT_NE(f.text.find(part), std::string::npos) << f.text;
}

TEST(PreflightVerdict, NothingSpeaksAgainstAKnownMission) {
  EXPECT_TRUE(findings_of(test::known_mission()).empty());
  EXPECT_TRUE(is_go({}));
}

TEST(PreflightVerdict, WhatTheFlightWouldRefuseIsNoGo) {
  Preflight p;
  p.refusals.push_back({Subject::start, "the start lies in rock"});
  const std::vector<Finding> found = findings_of(p);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].severity, Severity::no_go);
  EXPECT_EQ(found[0].subject, Subject::start);
  EXPECT_EQ(found[0].text, "the start lies in rock");
  EXPECT_FALSE(is_go(found));
}

TEST(PreflightVerdict, ABatteryForNoMoreThanTheReserveIsNoGo) {
  const std::vector<Finding> found = findings_with([](Preflight& p) {
    p.time->limits.battery_s = 20;
    p.time = time_budget(p.time->limits, 100);
  });
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].severity, Severity::no_go) << "reasons come first";
  EXPECT_EQ(found[0].subject, Subject::time);
  EXPECT_FALSE(is_go(found));
}

// It said GO.
TEST(PreflightVerdict, TimeForLessThanAStrideIsNoGo) {
  const std::vector<Finding> found = findings_with([](Preflight& p) {
    p.time->limits.max_flight_time_s = 30;
    p.time = time_budget(p.time->limits, 100);
  });
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].severity, Severity::no_go);
  EXPECT_EQ(found[0].subject, Subject::time);
  EXPECT_NE(found[0].text.find("the time is too short to explore: of 30 s"), std::string::npos)
      << found[0].text;
  EXPECT_EQ(found.size(), 1u) << "what it would explore is of no interest";
}

TEST(PreflightVerdict, WatchesForADeepCave) {
  expect_watch(only_with([](Preflight& p) { p.time = time_budget(p.time->limits, 2000); }), Subject::time,
               "2000 m from the start");
}

TEST(PreflightVerdict, WatchesForPassagesNarrowerThanTheClearance) {
  const auto narrow = [](double own_m3) { return [own_m3](Preflight& p) { p.cave->reachable_m3 = own_m3; }; };
  expect_watch(only_with(narrow(1500)), Subject::passages, "25 % of the space");
  EXPECT_TRUE(findings_with(narrow(1981)).empty()) << "less than a hundredth";
}

TEST(PreflightVerdict, WatchesForShaftsSteeperThanTheSensorsLook) {
  expect_watch(only_with([](Preflight& p) {
                 p.cave->blind_climb_fraction = 0.2;
                 p.cave->blind_climb = "it leads 8.0 m up";
               }),
               Subject::climbs, "20 % of the places");
}

TEST(PreflightVerdict, WatchesForAHoleNearTheStart) {
  const auto hole_at = [](double distance_m) {
    return [distance_m](Preflight& p) { p.cave->holes.push_back({core::Vec3(9, 2, 1), 0.8, distance_m}); };
  };
  expect_watch(only_with(hole_at(6)), Subject::hole, "6.0 m from a hole of the mesh, 0.8 m across");
  expect_watch(only_with(hole_at(40)), Subject::hole, "1 hole, the nearest 40 m from the start");
}

TEST(PreflightVerdict, WatchesForAnUncertainChoice) {
  const auto confidence = [](double c) { return [c](Preflight& p) { p.policy->confidence = c; }; };
  expect_watch(only_with(confidence(0.4)), Subject::confidence,
               "first in only 40 % of the resamplings, next is nearest");
  EXPECT_TRUE(findings_with(confidence(0.6)).empty());
}

TEST(PreflightVerdict, WatchesForANamedPolicyThatIsNotTheBest) {
  expect_watch(only_with([](Preflight& p) {
                 p.policy->selected = false;
                 p.policy->policy = "nearest_frontier";
                 p.policy->own = 1;
                 p.policy->confidence = 0.1;  // of no interest: it was named
               }),
               Subject::policy,
               "deep_cave is expected to do better in coverage averaged over the flight: 70 %, against 60 %");
}

TEST(PreflightVerdict, WatchesForANamedPolicyOfWhichNothingIsKnown) {
  expect_watch(only_with([](Preflight& p) {
                 p.policy->selected = false;
                 p.policy->policy = "my_own";
                 p.policy->own.reset();
                 p.policy->expected.clear();
               }),
               Subject::policy, "my_own has not been flown in caves like this");
  expect_watch(only_with([](Preflight& p) {
                 p.policy = PolicyFacts{};
                 p.policy->policy = "my_own";
                 p.policy->reason = "nothing like this cave was flown";
               }),
               Subject::policy, "nothing like this cave was flown");
}

// A cave unlike those flown was no-go.
TEST(PreflightVerdict, WatchesForAPolicyThatIsAFallback) {
  expect_watch(only_with([](Preflight& p) {
                 p.policy = PolicyFacts{};
                 p.policy->policy = "nearest_frontier";
                 p.policy->fallback = true;
                 p.policy->reason = "nothing like this cave was flown";
               }),
               Subject::policy, "no policy could be selected, so it is nearest_frontier");
}

TEST(PreflightVerdict, WatchesForACaveLargerThanTheFlightExplores) {
  expect_watch(only_with([](Preflight& p) { p.policy->expected[0].value = 0.55; }), Subject::coverage,
               "55 % of it is expected");
}

TEST(PreflightVerdict, SaysThatTheExperienceIsOfFlightsOfAnotherLength) {
  const auto horizon = [](double s) { return [s](Preflight& p) { p.policy->horizon_s = s; }; };
  EXPECT_TRUE(findings_with(horizon(300)).empty()) << "nearly all is covered sooner";
  const std::vector<Finding> longer = findings_with([](Preflight& p) {
    p.policy->horizon_s = 300;
    p.policy->expected[0].value = 0.5;
  });
  ASSERT_EQ(longer.size(), 2u);
  expect_watch(longer[1], Subject::coverage, "explores more");
  expect_watch(only_with(horizon(900)), Subject::coverage, "explores less");
  EXPECT_TRUE(findings_with(horizon(500)).empty());
}

TEST(PreflightVerdict, PassesOnWhatTheMeshSuggests) {
  expect_watch(only_with([](Preflight& p) { p.mesh_notes = {"likely y points up (up y)"}; }), Subject::cave,
               "likely y points up (up y)");
}

}  // namespace
}  // namespace karst::preflight
