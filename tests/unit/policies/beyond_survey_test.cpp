#include <gtest/gtest.h>

#include <karst/testing/bench.h>
#include <karst/testing/expect.h>

#include <utility>

#include "tests/unit/policies/sphere_sensor.h"

namespace {

using karst::Vec3;
using karst::testing::Bench;
using karst::testing::DrawnMap;
using karst::testing::DrawnSurvey;
using karst::testing::flies_to_frontier;
using karst::testing::gives_reason;
using karst::testing::mismatch;
using karst::testing::offers_frontiers;

// The surveyed passage goes from s to the east, past a; p is a pocket of it. The branch to b begins at j.
DrawnMap fork() {
  return {1.0, {R"(
    ############################
    #s.....j.......m......a?????
    ###p###.####################
    ###?###.####################
    #######.####################
    #######.####################
    #######.####################
    #######b####################
    #######?####################)"}};
}

const Vec3 kEastEnd{30.5, 7.5, 0.5}, kSouthEnd{7.5, -5.5, 0.5};

struct Flight {
  DrawnMap map = fork();
  Bench bench{karst_plugin_entry(), map};
  explicit Flight(char from) {
    bench.sensors = {karst::test::sphere_sensor(10)};
    bench.position = map.place(from);
  }
  void offer(std::uint32_t id, char place, std::uint32_t cells) {
    bench.offer(id, map.place(place), map.place(place), cells);
  }
  DrawnSurvey east() const { return DrawnSurvey().leg(map.place('s'), kEastEnd).lead(kEastEnd); }
};

TEST(BeyondSurvey, WhatTheSurveyLacksComesFirstThoughMoreAndNearerIsInIt) {
  Flight flight('s');
  flight.offer(1, 'a', 400);
  flight.offer(2, 'b', 10);
  flight.offer(3, 'p', 400);
  flight.bench.survey = flight.east();
  const karst::Decision d = flight.bench.decide();
  EXPECT_EQ(mismatch(d, offers_frontiers({2, 1, 3})), "");
  EXPECT_EQ(mismatch(d, gives_reason("beyond the survey")), "");
}

TEST(BeyondSurvey, WithoutASurveyTheMostForTheTimeComesFirst) {
  Flight flight('s');
  flight.offer(1, 'a', 400);
  flight.offer(2, 'b', 10);
  flight.offer(3, 'p', 400);
  const karst::Decision d = flight.bench.decide();
  EXPECT_EQ(mismatch(d, flies_to_frontier(3)), "");
  EXPECT_EQ(mismatch(d, gives_reason("m^3 to be seen in")), "");
}

TEST(BeyondSurvey, FliesThroughSurveyedPassagesToALeadAndFillsNothingInOnItsWay) {
  Flight flight('s');
  flight.offer(1, 'a', 20);
  flight.offer(3, 'p', 400);
  flight.bench.survey = flight.east();
  const karst::Decision d = flight.bench.decide();
  EXPECT_EQ(mismatch(d, offers_frontiers({1, 3})), "");
  EXPECT_EQ(mismatch(d, gives_reason("through surveyed passages to a lead 8.0 m further on")), "");
}

TEST(BeyondSurvey, ALeadThatTheSurveyorMarkedComesBeforeANearerEnd) {
  Flight flight('m');
  flight.offer(1, 'a', 20);
  flight.offer(2, 'b', 20);
  const Vec3 s = flight.map.place('s'), j = flight.map.place('j');
  DrawnSurvey survey = DrawnSurvey().leg(s, j).leg(j, kEastEnd).leg(j, kSouthEnd).lead(kEastEnd);
  flight.bench.survey = DrawnSurvey(survey).lead(kSouthEnd);
  EXPECT_EQ(mismatch(flight.bench.decide(), flies_to_frontier(1)), "") << "two ends alike: the nearer";
  flight.bench.survey.reset();
  Flight other('m');
  other.offer(1, 'a', 20);
  other.offer(2, 'b', 20);
  other.bench.survey = survey.lead(kSouthEnd, KARST_LEAD_CONTINUATION);
  EXPECT_EQ(mismatch(other.bench.decide(), flies_to_frontier(2)), "");
}

TEST(BeyondSurvey, ALeadWhereTheVehicleWasIsSpent) {
  Flight flight('s');
  flight.offer(1, 'a', 20);
  flight.offer(3, 'p', 400);
  flight.bench.survey = flight.east();
  flight.bench.position = kEastEnd - Vec3(3, 0, 0);
  flight.bench.decide();
  flight.bench.position = flight.map.place('s');
  EXPECT_EQ(mismatch(flight.bench.decide(), gives_reason("no lead is left")), "");
}

TEST(BeyondSurvey, TheMarginTellsHowFarOutsideIsBeyond) {
  // b is 6 m from the leg, and so 4.5 m from the passage.
  for (const auto& [margin, first] : {std::pair("4", 2u), std::pair("5", 1u)}) {
    Bench bench(karst_plugin_entry(), fork(), {{"margin", margin}});
    const DrawnMap map = fork();
    bench.sensors = {karst::test::sphere_sensor(10)};
    bench.position = map.place('m');
    bench.offer(1, map.place('a'), map.place('a'));
    bench.offer(2, map.place('b'), map.place('b'));
    bench.survey = DrawnSurvey().leg(map.place('s'), kEastEnd).lead(kEastEnd);
    EXPECT_EQ(mismatch(bench.decide(), flies_to_frontier(first)), "") << margin;
  }
}

TEST(BeyondSurvey, WorksWithoutAnyFrontier) {
  Bench bench(karst_plugin_entry(), fork(), {{"patience", "0"}});
  EXPECT_EQ(bench.decide().outcome, karst_outcome_t{KARST_OUTCOME_EXPLORED});
  bench.survey = DrawnSurvey();
  EXPECT_EQ(bench.decide().outcome, karst_outcome_t{KARST_OUTCOME_EXPLORED}) << "a survey without legs";
}

}  // namespace
