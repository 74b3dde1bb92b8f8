// Which part of a survey is made.
#include "sdk/survey_cave/survey_part.h"

#include <gtest/gtest.h>

#include "tests/unit/simulator/meshes.h"
#include "tests/unit/survey_cave/surveys.h"

namespace karst::survey_cave {
namespace {

using core::Vec3;
using test::error_of;
using test::SurveyMaker;

TEST(Part, IsChosenBySurveyByStationAndByBox) {
  SurveyMaker m;
  m.station("sys.upper.1", {0, 0, 0}), m.station("sys.upper.2", {10, 0, 0});
  m.station("sys.lower.1", {20, 0, 0}), m.station("sys.lower.2", {30, 0, 0});
  for (std::uint32_t i = 0; i < 3; ++i) m.leg(i, i + 1);
  m.survey.stations[1].aliases = {"sys.lower.0"};
  using Legs = std::vector<std::uint32_t>;
  EXPECT_EQ(part_of("f", m.survey, {}).legs, (Legs{0, 1, 2}));
  PartOptions o;
  o.survey = "upper";
  EXPECT_EQ(part_of("f", m.survey, o).legs, Legs{0});
  o.survey = "sys.lower";
  EXPECT_EQ(part_of("f", m.survey, o).legs, (Legs{1, 2})) << "the junction has a name there, too";
  o.survey = "sys";
  o.around = "lower.1";
  o.radius_m = 12;
  EXPECT_EQ(part_of("f", m.survey, o).legs, (Legs{1, 2}));
  o = {};
  o.box = Eigen::AlignedBox3d(Vec3(-1, -1, -1), Vec3(25, 1, 1));
  EXPECT_EQ(part_of("f", m.survey, o).legs, (Legs{0, 1}));
}

TEST(Part, SurfaceLegsAndDuplicatesAreLeftOutAndCounted) {
  SurveyMaker m = test::straight_passage(3, 10, 1);
  m.survey.legs[0].surface = true;
  m.survey.legs[2].duplicate = true;
  const SurveyPart part = part_of("f", m.survey, {});
  EXPECT_EQ(part.legs, std::vector<std::uint32_t>{1});
  EXPECT_EQ(part.stations, (std::vector<std::uint32_t>{1, 2}));
  EXPECT_NEAR(part.surface_m, 10, 1e-9);
  EXPECT_NEAR(part.duplicate_m, 10, 1e-9);
}

TEST(Part, WhatIsNotThereIsNamedWithTheNearestName) {
  SurveyMaker m = test::straight_passage(1, 10, 1);
  PartOptions o;
  o.survey = "cavr";
  EXPECT_NE(error_of([&] { part_of("f.th", m.survey, o); }).find("f.th: --survey cavr: "), std::string::npos);
  EXPECT_NE(error_of([&] { part_of("f.th", m.survey, o); }).find("cave"), std::string::npos);
  o = {};
  o.around = "cave.7";
  EXPECT_NE(error_of([&] { part_of("f.th", m.survey, o); }).find("no such station"), std::string::npos);
  o.around = "zzz";
  EXPECT_NE(error_of([&] {
              part_of("f.th", m.survey, o);
            }).find("no such station, nor one of a name like it; there is, for example, cave.0"),
            std::string::npos);
  m.station("other.1", {0, 0, 5});
  o.around = "1";
  EXPECT_NE(error_of([&] { part_of("f.th", m.survey, o); }).find("give the whole name"), std::string::npos);
  m.survey.legs[0].surface = true;
  EXPECT_NE(error_of([&] { part_of("f.th", m.survey, {}); }).find("no leg is left underground"),
            std::string::npos);
}

}  // namespace
}  // namespace karst::survey_cave
