// Which dimensions a cross-section gets: measured, interpolated or guessed.
#include "sdk/survey_cave/section_sizes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tests/unit/survey_cave/surveys.h"

namespace karst::survey_cave {
namespace {

using core::Vec3;
using test::SurveyMaker;

struct Sizes {
  PassageJoints passages;
  SectionSizes made;

  /// At an end of the only way along a leg.
  const SectionSize& of(std::uint32_t leg, std::size_t end) const {
    for (const Way& w : passages.ways)
      if (w.leg == leg) return made.at.at(w.joint.at(end));
    throw std::out_of_range("no such leg");
  }
};

Sizes sizes_of(const survey::Survey& survey) {
  const SurveyPart part = part_of("cave.th", survey, {});
  const PassageGraph graph = graph_of(survey, part, Vec3::Zero());
  Sizes sizes;
  sizes.passages = joints_of(survey, part, graph);
  sizes.made = section_sizes(survey, graph, sizes.passages, splays_of(survey, graph, Vec3::Zero()));
  return sizes;
}

SurveyMaker legs_along_x(int legs) {
  SurveyMaker m;
  for (int i = 0; i <= legs; ++i) m.station("a." + std::to_string(i), {10.0 * i, 0, 0});
  for (int i = 0; i < legs; ++i) m.leg(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i + 1));
  return m;
}

TEST(SectionSizes, WhatIsMissingIsInterpolatedAlongThePassage) {
  SurveyMaker m = legs_along_x(4);
  m.section(0, Vec3::UnitX(), 1, 1, 1, 1);
  m.section(3, Vec3::UnitX(), 4, 4, 4, 4);  // stations 1 and 2 lie between, 4 beyond
  const Sizes s = sizes_of(m.survey);
  EXPECT_NEAR(s.of(0, 1).extents.left_m, 2, 1e-9) << "after a third of the way";
  EXPECT_NEAR(s.of(1, 1).extents.down_m, 3, 1e-9);
  EXPECT_NEAR(s.of(3, 1).extents.up_m, 4, 1e-9) << "as at the last one measured";
  EXPECT_TRUE(s.of(0, 0).all && !s.of(0, 1).any);
  for (const SectionSize& size : s.made.at) EXPECT_FALSE(size.standing_in);
}

TEST(SectionSizes, OneSideAloneIsMeasuredAndTheOtherIsInterpolated) {
  SurveyMaker m = legs_along_x(1);
  m.section(0, Vec3::UnitX(), 3, 1, 1, 1).dimensions.right_m.reset();
  m.section(1, Vec3::UnitX(), 2, 4, 1, 1);
  const SectionSize size = sizes_of(m.survey).of(0, 0);
  EXPECT_EQ(size.extents.left_m, 3);
  EXPECT_NEAR(size.extents.right_m, 3, 1e-9) << "half of the width at the other end";
  EXPECT_TRUE(size.any && !size.all);
}

TEST(SectionSizes, WithoutAnyNeighbourTheMediansStandInAndAMetreWithoutAnyMeasurement) {
  SurveyMaker m;
  for (int i = 0; i < 4; ++i) m.station("a." + std::to_string(i), {10.0 * i, 0, 0});
  m.leg(0, 1), m.leg(2, 3);
  m.section(0, Vec3::UnitX(), 2, 2, 3, 1);
  const Sizes s = sizes_of(m.survey);
  EXPECT_EQ(s.made.measured_half_width_m, 2);
  EXPECT_EQ(s.of(1, 0).extents.left_m, 2);
  EXPECT_EQ(s.of(1, 1).extents.up_m, 3);
  EXPECT_EQ(s.of(1, 1).extents.down_m, 1);
  EXPECT_TRUE(s.of(1, 0).standing_in && !s.of(0, 1).standing_in);
  m.survey.sections.clear();
  EXPECT_EQ(sizes_of(m.survey).of(0, 0).extents.left_m, 1);
  EXPECT_EQ(sizes_of(m.survey).made.measured_up_m, 0);
}

TEST(SectionSizes, DimensionsThatAreAllZeroAreNotMeasured) {
  SurveyMaker m = test::straight_passage(2, 5, 1.5);
  m.survey.sections[1].dimensions = {0.0, 0.0, 0.0, 0.0};
  EXPECT_NEAR(sizes_of(m.survey).of(0, 1).extents.left_m, 1.5, 1e-9);
  EXPECT_FALSE(sizes_of(m.survey).of(0, 1).any);
}

TEST(SectionSizes, ASectionThatFacesTheOtherWayHasLeftForRight) {
  SurveyMaker m = legs_along_x(2);
  for (const std::uint32_t s : {0u, 1u, 2u})
    m.section(s, s == 1 ? Vec3(-Vec3::UnitX()) : Vec3::UnitX(), 3, 1, 2, 1);
  const Sizes s = sizes_of(m.survey);
  const Joint& middle = s.passages.joints.at(s.passages.ways.at(0).joint[1]);
  const Extents& x = s.of(0, 1).extents;
  EXPECT_EQ(middle.normal.x() > 0 ? x.right_m : x.left_m, 3);
  EXPECT_EQ(middle.normal.x() > 0 ? x.left_m : x.right_m, 1);
}

TEST(SectionSizes, LeftAndRightOfASectionThatLooksAcrossThePassageSayNothing) {
  SurveyMaker m = test::straight_passage(2, 10, 2);
  m.survey.sections[1].facing = Vec3::UnitY();
  m.survey.sections[1].dimensions = {9.0, 9.0, 1.0, 1.0};
  const Extents x = sizes_of(m.survey).of(0, 1).extents;
  EXPECT_NEAR(x.left_m, 2, 1e-9);
  EXPECT_EQ(x.up_m, 1);
}

TEST(SectionSizes, ASidePassageIsNoWiderAtTheJunctionThanAtItsOtherEnd) {
  SurveyMaker m = test::straight_passage(2, 10, 8);
  m.station("side.1", {10, 20, 0});
  m.leg(1, 3, 1);
  m.section(3, Vec3::UnitY(), 0.5, 0.5, 0.5, 0.5, 1);
  const Sizes s = sizes_of(m.survey);
  EXPECT_EQ(s.of(2, 0).extents.left_m, 0.5);
  EXPECT_FALSE(s.of(2, 0).all);
  EXPECT_EQ(s.of(0, 1).extents.left_m, 8);
}

TEST(SectionSizes, SplaysMeasureWhereNothingWasNoted) {
  SurveyMaker m = legs_along_x(1);
  m.section(1, Vec3::UnitX(), 5, 5, 5, 5);
  for (const Vec3& v : {Vec3(0, 2, 0), Vec3(0, -1, 0), Vec3(0, 0, 3)}) m.splay(0, v);
  EXPECT_FALSE(sizes_of(m.survey).of(0, 0).any) << "three are too few";
  m.splay(0, {0.2, 0, -0.5});
  m.splay(0, {8, 6, 0});  // along the passage
  const Sizes s = sizes_of(m.survey);
  const SectionSize& size = s.of(0, 0);
  const bool outwards = s.passages.joints.at(s.passages.ways.at(0).joint[0]).normal.x() > 0;
  EXPECT_EQ(outwards ? size.extents.left_m : size.extents.right_m, 2);
  EXPECT_EQ(outwards ? size.extents.right_m : size.extents.left_m, 1);
  EXPECT_EQ(size.extents.up_m, 3);
  EXPECT_EQ(size.extents.down_m, 0.5);
  EXPECT_TRUE(size.all);
}

TEST(SectionSizes, SplaysOnTheSurfaceAreNone) {
  SurveyMaker m = legs_along_x(1);
  for (int i = 0; i < 8; ++i) {
    const double a = 2 * std::numbers::pi * i / 8;
    m.splay(0, {0, std::cos(a), std::sin(a)});
    m.survey.splays.back().surface = true;
  }
  EXPECT_FALSE(sizes_of(m.survey).of(0, 0).any);
}

}  // namespace
}  // namespace karst::survey_cave
