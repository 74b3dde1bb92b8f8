// Which dimensions a leg gets: measured, interpolated or guessed; and which part of a survey is made.
#include "sdk/survey_cave/passages.h"

#include <gtest/gtest.h>

#include "core_stack/common/error.h"
#include "sdk/survey_cave/survey_findings.h"
#include "tests/unit/simulator/meshes.h"
#include "tests/unit/survey_cave/surveys.h"

namespace karst::survey_cave {
namespace {

using core::Vec3;
using test::error_of;
using test::SurveyMaker;

struct Made {
  SurveyPart part;
  PassageGraph graph;
  Passages passages;
};

Made made_of(const survey::Survey& survey, const PartOptions& options = {}, double least_m = 0.1) {
  Made made;
  made.part = part_of("cave.th", survey, options);
  made.graph = graph_of(survey, made.part, Vec3::Zero());
  made.passages = passages_of(survey, made.part, made.graph, Vec3::Zero(), least_m);
  return made;
}

const Tube& tube_of(const Made& made, std::uint32_t leg) {
  for (const Tube& t : made.passages.tubes)
    if (t.leg() == leg) return t;
  throw std::out_of_range("no such tube");
}

TEST(Passages, LeftAndRightAreThoseOfTheLegWhicheverWayItWasMeasured) {
  SurveyMaker m;
  m.station("a.0", {0, 0, 0}), m.station("a.1", {8, 0, 0});
  m.leg(1, 0);  // measured towards -x, while the sections face +x: their left is +y
  m.section(0, Vec3::UnitX(), 3, 1, 2, 0.5);
  m.section(1, Vec3::UnitX(), 3, 1, 2, 0.5);
  const Made made = made_of(m.survey);
  const Tube& t = tube_of(made, 0);
  EXPECT_NEAR(t.distance({4, 3, 0}), 0, 0.02);
  EXPECT_NEAR(t.distance({4, -1, 0}), 0, 0.02);
  EXPECT_NEAR(t.distance({4, 0, 2}), 0, 0.02);
  EXPECT_NEAR(t.distance({4, 0, -0.5}), 0, 0.02);
  EXPECT_TRUE(made.passages.guessed.empty());
}

// Up and down of a sloping passage are vertical.
TEST(Passages, UpAndDownOfASlopingPassageAreMeasuredVertically) {
  SurveyMaker m;
  m.station("a.0", {0, 0, 0}), m.station("a.1", {10, 0, 6});
  m.leg(0, 1);
  for (const std::uint32_t s : {0u, 1u}) m.section(s, Vec3::UnitX(), 1, 1, 1.5, 0.5);
  const Made made = made_of(m.survey);
  const Tube& t = tube_of(made, 0);
  EXPECT_NEAR(t.distance({5, 0, 3 + 1.5}), 0, 0.03);
  EXPECT_NEAR(t.distance({5, 0, 3 - 0.5}), 0, 0.03);
}

TEST(Passages, AShaftIsAsDeepAsItIsWideAndEndsWhereUpAndDownSay) {
  SurveyMaker m;
  m.station("p.top", {0, 0, 0}), m.station("p.bottom", {0, 0, -20});
  m.leg(0, 1);
  for (const std::uint32_t s : {0u, 1u}) m.section(s, Vec3::UnitY(), 2, 1, 3, 0.5);
  const Made made = made_of(m.survey);
  const Tube& t = tube_of(made, 0);
  EXPECT_NEAR(t.distance({-2, 0, -10}), 0, 0.03) << "left of north is west";
  EXPECT_NEAR(t.distance({1, 0, -10}), 0, 0.03);
  EXPECT_NEAR(t.distance({0, 1.5, -10}), 0, 0.03) << "front and back: half of the width";
  EXPECT_NEAR(t.distance({0, -1.5, -10}), 0, 0.03);
  EXPECT_NEAR(t.distance({0, 0, 3}), 0, 1e-6) << "the roof";
  EXPECT_NEAR(t.distance({0, 0, -20.5}), 0, 1e-6) << "the floor";
  EXPECT_NEAR(made.passages.shafts_m, 20, 1e-9);
}

TEST(Passages, MissingDimensionsAreInterpolatedAlongThePassageAndCounted) {
  SurveyMaker m;
  for (int i = 0; i < 5; ++i) m.station("a." + std::to_string(i), {10.0 * i, 0, 0});
  for (std::uint32_t i = 0; i < 4; ++i) m.leg(i, i + 1);
  m.section(0, Vec3::UnitX(), 1, 1, 1, 1);
  m.section(3, Vec3::UnitX(), 4, 4, 4, 4);  // stations 1 and 2 lie between, 4 beyond
  const Made made = made_of(m.survey);
  EXPECT_NEAR(tube_of(made, 0).size_at(1).x(), 4, 1e-6) << "2 m to either side after a third of the way";
  EXPECT_NEAR(tube_of(made, 1).size_at(1).x(), 6, 1e-6);
  EXPECT_NEAR(tube_of(made, 3).size_at(1).y(), 8, 1e-6) << "as at the last one measured";
  double without_m = 0;
  for (const GuessedLeg& g : made.passages.guessed) without_m += g.without_m;
  EXPECT_NEAR(without_m, 5 + 10 + 5 + 5, 1e-6);
  EXPECT_EQ(made.passages.defaults_m, 0);
}

TEST(Passages, WithoutAnyNeighbourTheMediansStandInAndAMetreWithoutAnyMeasurement) {
  SurveyMaker m;
  for (int i = 0; i < 4; ++i) m.station("a." + std::to_string(i), {10.0 * i, 0, 0});
  m.leg(0, 1), m.leg(2, 3);
  m.section(0, Vec3::UnitX(), 2, 2, 3, 1);
  const Made made = made_of(m.survey);
  EXPECT_NEAR(tube_of(made, 1).size_at(0.5).x(), 4, 1e-6);
  EXPECT_NEAR(tube_of(made, 1).size_at(0.5).y(), 4, 1e-6);
  EXPECT_NEAR(made.passages.defaults_m, 10, 1e-6);
  m.survey.sections.clear();
  EXPECT_NEAR(tube_of(made_of(m.survey), 0).size_at(0.5).x(), 2, 1e-6);
}

TEST(Passages, DimensionsThatAreAllZeroAreNotMeasured) {
  SurveyMaker m = test::straight_passage(2, 5, 1.5);
  m.survey.sections[1].dimensions = {0.0, 0.0, 0.0, 0.0};
  EXPECT_NEAR(tube_of(made_of(m.survey), 0).size_at(1).x(), 3, 1e-6);
}

TEST(Passages, FourSplaysAcrossThePassageGiveItsSection) {
  SurveyMaker m;
  m.station("a.0", {0, 0, 0}), m.station("a.1", {6, 0, 0});
  m.leg(0, 1);
  for (const std::uint32_t s : {0u, 1u}) {
    m.section(s, Vec3::UnitX(), 9, 9, 9, 9);
    for (int i = 0; i < 8; ++i) {
      const double a = 2 * std::numbers::pi * i / 8;
      m.splay(s, {0.2, 1.5 * std::cos(a), 1.5 * std::sin(a)});
    }
    m.splay(s, {7, 0.5, 0.1});  // along the passage: tells nothing of its section
  }
  const Made made = made_of(m.survey);
  EXPECT_EQ(made.passages.sections_from_splays, 2u);
  EXPECT_NEAR(made.passages.splays_m, 6, 1e-9);
  for (int i = 0; i < 16; ++i) {
    const double a = 2 * std::numbers::pi * i / 16;
    EXPECT_NEAR(tube_of(made, 0).distance({3, 1.5 * std::cos(a), 1.5 * std::sin(a)}), 0, 0.03);
  }
}

TEST(Passages, ASidePassageIsNoWiderAtTheJunctionThanAtItsOtherEnd) {
  SurveyMaker m = test::straight_passage(2, 10, 8);
  m.station("side.1", {10, 20, 0});
  m.leg(1, 3, 1);
  m.section(3, Vec3::UnitY(), 0.5, 0.5, 0.5, 0.5, 1);
  const Made made = made_of(m.survey);
  EXPECT_NEAR(tube_of(made, 2).size_at(0).x(), 1, 1e-6);
  EXPECT_NE(tube_of(made, 2).passage(), tube_of(made, 0).passage());
  EXPECT_EQ(tube_of(made, 0).passage(), tube_of(made, 1).passage());
}

TEST(Passages, NarrowLegsAreFoundAndEndTheVehiclesReach) {
  SurveyMaker m = test::straight_passage(4, 10, 1);
  m.survey.sections[2].dimensions = {0.1, 0.1, 1.0, 1.0};
  const Made made = made_of(m.survey);
  SurveyReport report;
  report.vehicle_width_m = 0.6;
  tell_of_passages(m.survey, made.part, made.graph, made.passages, report);
  EXPECT_NEAR(report.passage_m, 40, 1e-9);
  EXPECT_NEAR(report.narrow_m, 2 * 10 * 0.4 / 1.8, 1.1) << "2 m wide at 10 m, 0.2 m at 0";
  EXPECT_NEAR(within_reach_m(m.survey, made.graph, made.passages, 0.6, {5, 0, 0}), 10, 1e-9);
  EXPECT_NEAR(within_reach_m(m.survey, made.graph, made.passages, 0.1, {5, 0, 0}), 40, 1e-9);
}

TEST(Passages, PartsFloodsAndBlocksAreTold) {
  SurveyMaker m = test::straight_passage(2, 10, 1);
  m.station("far.1", {0, 100, -30}), m.station("far.2", {0, 105, -30});
  m.leg(3, 4).style = survey::Style::diving;
  m.survey.stations[4].comment = "Siphon terminal";
  m.survey.stations[2].continuation = true;
  const Made made = made_of(m.survey);
  SurveyReport report;
  tell_of_passages(m.survey, made.part, made.graph, made.passages, report);
  ASSERT_EQ(report.parts.size(), 2u);
  EXPECT_NEAR(report.parts[0].legs_m, 20, 1e-9);
  EXPECT_EQ(report.parts[1].station, "far.1");
  EXPECT_NEAR(report.flooded_m, 5, 1e-9);
  EXPECT_NEAR(report.depth_m, 30, 1e-9);
  ASSERT_EQ(report.blocked.size(), 1u);
  EXPECT_EQ(report.blocked[0].station, "far.2");
  EXPECT_EQ(report.continuations, std::vector<std::string>{"cave.2"});
  ASSERT_EQ(report.guessed.size(), 1u);
  EXPECT_EQ(report.guessed[0].name, "far");
  EXPECT_NEAR(report.guessed[0].without_m, 5, 1e-9);
}

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
  m.station("other.1", {0, 0, 5});
  o.around = "1";
  EXPECT_NE(error_of([&] { part_of("f.th", m.survey, o); }).find("give the whole name"), std::string::npos);
  m.survey.legs[0].surface = true;
  EXPECT_NE(error_of([&] { part_of("f.th", m.survey, {}); }).find("no leg is left underground"),
            std::string::npos);
}

}  // namespace
}  // namespace karst::survey_cave
