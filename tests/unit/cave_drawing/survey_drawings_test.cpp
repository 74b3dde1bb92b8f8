#include "sdk/cave_drawing/survey_drawings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sdk/cave_drawing/leg_walls.h"
#include "sdk/cave_drawing/unrolled_survey.h"
#include "tests/unit/cave_drawing/drawn_lines.h"
#include "tests/unit/survey_cave/surveys.h"

namespace karst::cave_drawing {
namespace {

using survey::Extend;
using test::SurveyMaker;

TEST(SurveyDrawings, APassageIsAsWideAndAsHighAsItsSections) {
  const SurveyMaker made = test::straight_passage(4, 10, 2);  // 40 m, walls at 2 m on each side
  const CaveDrawings drawings = survey_drawings(made.survey, {}, "cave.svx");
  for (const Drawing* d : {&drawings.plan, &drawings.extended, &drawings.projected}) {
    EXPECT_NEAR(test::area_m2(*d), 160, 3) << core::name_of(d->view);
    EXPECT_NEAR(test::span_of(d->walls, 0).length(), 40, 0.2);
    EXPECT_NEAR(test::span_of(d->walls, 1).length(), 4, 0.2);
    EXPECT_EQ(d->centreline.size(), 4u);
    EXPECT_EQ(test::count_of(*d, Mark::Kind::station), 5);
  }
  EXPECT_NEAR(drawings.facts.length_m.value_or(0), 40, 1e-9);
  EXPECT_FALSE(drawings.facts.volume_m3);
  for (const Mark& m : drawings.plan.marks)
    if (m.kind == Mark::Kind::station) {
      EXPECT_EQ(m.text.find('.'), std::string::npos) << m.text;
    }
}

TEST(SurveyDrawings, AMissingDimensionIsInterpolatedAlongThePassageAndItsWallUncertain) {
  SurveyMaker made = test::straight_passage(4, 10, 2);
  made.survey.sections[2].dimensions.right_m.reset();
  made.survey.sections[2].dimensions.down_m.reset();
  const CaveDrawings drawings = survey_drawings(made.survey, {}, "cave.svx");
  for (const Drawing* d : {&drawings.plan, &drawings.extended}) {
    EXPECT_NEAR(test::area_m2(*d), 160, 3) << "as wide and high as beside it: " << core::name_of(d->view);
    const test::Span along = test::span_of(d->uncertain_walls, 0),
                     across = test::span_of(d->uncertain_walls, 1);
    EXPECT_NEAR(along.low, 10, 1) << "the wall between the stations that have it";
    EXPECT_NEAR(along.high, 30, 1);
    EXPECT_NEAR(across.high, -2, 0.1) << "the right wall, and the floor";
  }
}

TEST(SurveyDrawings, ALegWithDimensionsAtOneEndHasUncertainWallsAndOneWithoutAnyIsALine) {
  SurveyMaker made = test::straight_passage(3, 10, 2);
  made.survey.sections.resize(2);
  const CaveDrawings drawings = survey_drawings(made.survey, {}, "cave.svx");
  EXPECT_NEAR(test::area_m2(drawings.plan), 80, 3) << "two legs of three";
  EXPECT_NEAR(test::span_of(drawings.plan.uncertain_walls, 0).high, 20, 0.2);
  EXPECT_EQ(drawings.plan.centreline.size(), 3u);
  for (LegEnd end : LegWalls(made.survey).of(made.survey.legs[2]).drawn) EXPECT_EQ(end.width_m, 0);
}

/// East for 10 m, then north for 10 m, then down 5 m.
SurveyMaker corner() {
  SurveyMaker made;
  made.station("a", {0, 0, 0});
  made.station("b", {10, 0, 0});
  made.station("c", {10, 10, 0});
  made.station("d", {10, 10, -5});
  for (std::uint32_t i = 0; i < 3; ++i) made.leg(i, i + 1);
  return made;
}

double s_of(const UnrolledSurvey& unrolled, std::size_t station) {
  return unrolled.s_m[station].value_or(std::numeric_limits<double>::quiet_NaN());
}

TEST(SurveyDrawings, AnExtendedProfileUnrollsACornerAndKeepsAShaftUpright) {
  const UnrolledSurvey unrolled = unrolled_survey(corner().survey);
  EXPECT_DOUBLE_EQ(s_of(unrolled, 1), 10);
  EXPECT_DOUBLE_EQ(s_of(unrolled, 2), 20);
  EXPECT_DOUBLE_EQ(s_of(unrolled, 3), 20);
}

TEST(SurveyDrawings, LegsGoWhereTheirSurveyorExtendsThem) {
  SurveyMaker made = corner();
  made.survey.legs[1].extend = Extend::left;
  EXPECT_DOUBLE_EQ(s_of(unrolled_survey(made.survey), 2), 0);
  made.survey.legs[1].extend = Extend::reverse;
  EXPECT_DOUBLE_EQ(s_of(unrolled_survey(made.survey), 2), 0);
  made.survey.legs[1].extend = Extend::vertical;
  EXPECT_DOUBLE_EQ(s_of(unrolled_survey(made.survey), 2), 10);
  made.survey.legs[1].extend = Extend::hide;
  EXPECT_FALSE(unrolled_survey(made.survey).legs[1]);
  EXPECT_TRUE(unrolled_survey(made.survey).legs[2]);
  // Measured towards the entrance, and extended to the right: its first station is on the left.
  std::swap(made.survey.legs[1].from, made.survey.legs[1].to);
  made.survey.legs[1].extend = Extend::right;
  EXPECT_DOUBLE_EQ(s_of(unrolled_survey(made.survey), 2), 0);
}

TEST(SurveyDrawings, AnIgnoredLegLeadsNowhereAndALoopIsDrawnOnce) {
  SurveyMaker made = corner();
  made.station("e", {0, 10, 0});
  made.leg(2, 4);
  made.leg(4, 0).extend = Extend::ignore;
  const UnrolledSurvey unrolled = unrolled_survey(made.survey);
  EXPECT_DOUBLE_EQ(s_of(unrolled, 4), 30) << "the long way round";
  EXPECT_FALSE(unrolled.legs[4]);
  made.survey.legs[4].extend = Extend::normal;
  const UnrolledSurvey loop = unrolled_survey(made.survey);
  EXPECT_TRUE(loop.legs[4]);
  ASSERT_EQ(loop.twice.size(), 1u) << "the loop is cut once";
  for (std::size_t i : {0u, 1u, 3u, 4u}) {
    const survey::Leg& leg = made.survey.legs[i];
    const core::Vec3 d = made.survey.stations[leg.to].position_m - made.survey.stations[leg.from].position_m;
    ASSERT_TRUE(loop.legs[i]);
    EXPECT_NEAR(std::abs(loop.legs[i]->first - loop.legs[i]->second), d.head<2>().norm(), 1e-9);
  }
  const CaveDrawings drawings = survey_drawings(made.survey, {}, "cave.svx");
  EXPECT_EQ(test::count_of(drawings.extended, Mark::Kind::joint), 2) << "a letter at both ends";
}

TEST(SurveyDrawings, BranchesAtOneHeightDoNotLieOnEachOther) {
  SurveyMaker made = test::straight_passage(6, 10, 2);
  for (const double y : {30.0, -30.0}) {  // both from the station at 30 m
    const std::uint32_t end = made.station("", {30, y, 0});
    made.leg(3, end, end);
    made.section(end, core::Vec3::UnitY(), 2, 2, 2, 2, end);
  }
  const CaveDrawings drawings = survey_drawings(made.survey, {}, "cave.svx");
  EXPECT_NEAR(test::area_m2(drawings.extended), (60 + 2 * 30) * 4, 5);
  EXPECT_EQ(drawings.extended.links.size(), 2u);
  EXPECT_EQ(test::count_of(drawings.extended, Mark::Kind::joint), 4);
}

TEST(SurveyDrawings, APartThatGoesToTheLeftDoesNotCoverTheOneBeforeIt) {
  SurveyMaker made = corner();  // from 0 to 20 m
  made.station("e", {0, 50, 0});
  made.station("f", {60, 50, 0});
  made.leg(4, 5).extend = Extend::left;
  const UnrolledSurvey unrolled = unrolled_survey(made.survey);
  EXPECT_DOUBLE_EQ(s_of(unrolled, 5), 30) << "10 m beside the first part";
  EXPECT_DOUBLE_EQ(s_of(unrolled, 4), 90);
  ASSERT_TRUE(unrolled.legs[3]);
  EXPECT_EQ(*unrolled.legs[3], std::pair(90.0, 30.0));
}

TEST(SurveyDrawings, ACaveOfTenKilometresIsDrawnWithCoarserCells) {
  SurveyMaker made;
  for (const core::Vec3& at : {core::Vec3(0, 0, 0), core::Vec3(9000, 8500, 0)}) {
    const std::uint32_t first = made.station("", at);
    made.leg(first, made.station("", at + core::Vec3(100, 0, 0)), first);
    for (const std::uint32_t s : {first, first + 1})
      made.section(s, core::Vec3::UnitX(), 20, 20, 5, 5, first);
  }
  const CaveDrawings drawings = survey_drawings(made.survey, {}, "cave.svx");
  EXPECT_NEAR(test::area_m2(drawings.plan), 2 * 100 * 40, 500);
}

TEST(SurveyDrawings, HeightsAndLengthsCountFromTheEntrance) {
  SurveyMaker made = corner();
  made.survey.stations[3].entrance = true;
  made.survey.stations[0].continuation = true;
  const CaveDrawings drawings = survey_drawings(made.survey, {}, "cave.svx");
  for (const Mark& m : drawings.extended.marks) {
    if (m.kind == Mark::Kind::entrance) {
      EXPECT_EQ(m.at, Point(0, 0));
    }
    if (m.kind == Mark::Kind::unknown_end) {
      EXPECT_EQ(m.at, Point(20, 5));
    }
  }
  EXPECT_EQ(test::count_of(drawings.plan, Mark::Kind::unknown_end), 1);
  EXPECT_NEAR(drawings.facts.depth_m.value_or(0), 5, 1e-9);
}

TEST(SurveyDrawings, WhatIsOverGroundIsLeftOut) {
  SurveyMaker made = corner();
  made.station("hill", {500, 0, 100});
  made.leg(0, 4).surface = true;
  const CaveDrawings drawings = survey_drawings(made.survey, {}, "cave.svx");
  EXPECT_EQ(drawings.plan.centreline.size(), 3u);
  EXPECT_EQ(test::count_of(drawings.plan, Mark::Kind::station), 4);
}

TEST(SurveyDrawings, OneStationAndWhatIsNoNumberAreRefused) {
  SurveyMaker one;
  one.station("a", {0, 0, 0});
  EXPECT_NE(test::refusal_by([&] {
              survey_drawings(one.survey, {}, "a.svx");
            }).find("a.svx: the survey has no leg"),
            std::string::npos);
  SurveyMaker bad = corner();
  bad.survey.stations[1].position_m.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(test::refusal_by([&] { survey_drawings(bad.survey, {}, "a.svx"); }).find("station b: "),
            std::string::npos);
}

}  // namespace
}  // namespace karst::cave_drawing
