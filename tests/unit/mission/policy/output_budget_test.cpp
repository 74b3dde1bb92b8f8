#include "core_stack/mission/policy/output_budget.h"

#include <gtest/gtest.h>

namespace karst::core {
namespace {

const OutputLimits kSmall{.drawn_points = 100, .drawings = 8, .log_bytes = 1000};

Decision drawing(std::size_t drawings, std::size_t points_each) {
  Decision d;
  d.drawings.assign(drawings, {Drawing::Kind::points, std::vector<Vec3>(points_each, Vec3::Zero()), 0, ""});
  return d;
}

TEST(OutputBudget, KeepsWhatAnOrdinaryPolicyDrawsAndLogs) {
  OutputBudget budget;
  for (int decision = 0; decision < 500; ++decision) {
    Decision d = drawing(5, 30);
    d.log.assign(5, std::string(100, 'x'));
    budget.trim(d);
    ASSERT_EQ(d.drawings.size(), 5u) << decision;
    ASSERT_EQ(d.log.size(), 5u);
  }
}

TEST(OutputBudget, EndsAtThePointsOfAFlightAndSaysSoOnce) {
  OutputBudget budget(kSmall);
  Decision first = drawing(1, 90), second = drawing(2, 10), third = drawing(1, 0);
  budget.trim(first), budget.trim(second), budget.trim(third);
  EXPECT_EQ(first.drawings.size(), 1u);
  EXPECT_TRUE(first.log.empty());
  EXPECT_EQ(second.drawings.size(), 1u);
  ASSERT_EQ(second.log.size(), 1u);
  EXPECT_NE(second.log[0].find("drawn all that a flight may"), std::string::npos);
  EXPECT_TRUE(third.drawings.empty());
  EXPECT_TRUE(third.log.empty());
}

TEST(OutputBudget, CountsDrawingsWithoutPointsAsWell) {
  OutputBudget budget(kSmall);
  Decision d = drawing(100, 0);
  budget.trim(d);
  EXPECT_EQ(d.drawings.size(), 8u);
}

TEST(OutputBudget, EndsAtTheLogOfAFlightAndSaysSoOnce) {
  OutputBudget budget(kSmall);
  std::size_t lines = 0, notes = 0;
  for (int decision = 0; decision < 100; ++decision) {
    Decision d;
    d.log = {std::string(60, 'x'), ""};
    budget.trim(d);
    lines += d.log.size();
    for (const std::string& line : d.log)
      notes += line.find("logged all that a flight may") != std::string::npos;
  }
  EXPECT_EQ(notes, 1u);
  EXPECT_LE(lines, 1000u / 40 + 1);
  EXPECT_GE(lines, 10u);
}

}  // namespace
}  // namespace karst::core
