// What is told of the passages: what is narrow, within reach, flooded, blocked, and in how many parts.
#include "sdk/survey_cave/survey_findings.h"

#include <gtest/gtest.h>

#include "tests/unit/survey_cave/made_passages.h"

namespace karst::survey_cave {
namespace {

using test::MadePassages;
using test::passages_made;
using test::SurveyMaker;

TEST(Findings, NarrowLegsAreFoundAndEndTheVehiclesReach) {
  SurveyMaker m = test::straight_passage(4, 10, 1);
  m.survey.sections[2].dimensions = {0.1, 0.1, 1.0, 1.0};
  const MadePassages made = passages_made(m.survey);
  SurveyReport report;
  report.obstacles.vehicle_width_m = 0.6;
  tell_of_passages(m.survey, made.part, made.graph, made.passages, report);
  EXPECT_NEAR(report.passage_m, 40, 1e-9);
  EXPECT_NEAR(report.obstacles.narrow_m, 2 * 10 * 0.4 / 1.8, 1.1) << "2 m wide at 10 m, 0.2 m at 0";
  EXPECT_NEAR(within_reach_m(m.survey, made.graph, made.passages, 0.6, {5, 0, 0}), 10, 1e-9);
  EXPECT_NEAR(within_reach_m(m.survey, made.graph, made.passages, 0.1, {5, 0, 0}), 40, 1e-9);
}

TEST(Findings, PartsFloodsAndBlocksAreTold) {
  SurveyMaker m = test::straight_passage(2, 10, 1);
  m.station("far.1", {0, 100, -30}), m.station("far.2", {0, 105, -30});
  m.leg(3, 4).style = survey::Style::diving;
  m.survey.stations[4].comment = "Siphon terminal";
  m.survey.stations[2].continuation = true;
  const MadePassages made = passages_made(m.survey);
  SurveyReport report;
  tell_of_passages(m.survey, made.part, made.graph, made.passages, report);
  ASSERT_EQ(report.parts.size(), 2u);
  EXPECT_NEAR(report.parts[0].legs_m, 20, 1e-9);
  EXPECT_EQ(report.parts[1].station, "far.1");
  EXPECT_NEAR(report.obstacles.flooded_m, 5, 1e-9);
  EXPECT_NEAR(report.depth_m, 30, 1e-9);
  ASSERT_EQ(report.obstacles.blocked.size(), 1u);
  EXPECT_EQ(report.obstacles.blocked[0].station, "far.2");
  EXPECT_EQ(report.obstacles.continuations, std::vector<std::string>{"cave.2"});
  ASSERT_EQ(report.dimensions.guessed.size(), 1u);
  EXPECT_EQ(report.dimensions.guessed[0].name, "far");
  EXPECT_NEAR(report.dimensions.guessed[0].without_m, 5, 1e-9);
}

}  // namespace
}  // namespace karst::survey_cave
