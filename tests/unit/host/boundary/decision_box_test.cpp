#include "sdk/host/boundary/decision_box.h"

#include <gtest/gtest.h>

#include <cmath>

namespace karst::host {
namespace {

karst_goal_t good() {
  karst_goal_t g{};
  g.position = {1, 2, 3};
  g.tolerance_m = 0.5;
  return g;
}

TEST(GoalFault, WellFormedGoalHasNone) {
  karst_goal_t g = good();
  EXPECT_EQ(goal_fault(g), "");
  g.heading_rad = NAN;
  EXPECT_EQ(goal_fault(g), "") << "any heading";
}

TEST(GoalFault, EachFieldIsLookedAt) {
  const auto fault = [](auto&& spoil) {
    karst_goal_t g = good();
    spoil(g);
    return goal_fault(g);
  };
  EXPECT_EQ(fault([](auto& g) { g.position.z = INFINITY; }), "its position is not finite");
  EXPECT_EQ(fault([](auto& g) { g.position.x = 2e5; }), "its position is more than 100 km away");
  EXPECT_NE(fault([](auto& g) { g.heading_rad = INFINITY; }), "");
  EXPECT_NE(fault([](auto& g) { g.tolerance_m = 0; }), "");
  EXPECT_NE(fault([](auto& g) { g.tolerance_m = NAN; }), "");
  EXPECT_NE(fault([](auto& g) { g.max_speed_mps = -1; }), "");
  EXPECT_NE(fault([](auto& g) { g.max_speed_mps = NAN; }), "");
  for (const double crawl_mps : {1e-300, 1e-9, 1e-4, 0.049})
    EXPECT_EQ(fault([=](auto& g) { g.max_speed_mps = crawl_mps; }),
              "its speed limit is below 0.05 m/s (0 stands for the mission's)");
  EXPECT_EQ(fault([](auto& g) { g.max_speed_mps = 0.05; }), "");
  EXPECT_NE(fault([](auto& g) { g.score = INFINITY; }), "");
  EXPECT_NE(fault([](auto& g) { g.why = {"two\nlines", 9}; }), "");
  const std::string longer(241, 'x');
  EXPECT_EQ(fault([&](auto& g) {
              g.why = {longer.data(), 241};
            }),
            "its why is 241 bytes long, the limit is 240");
}

TEST(DecisionBox, CarriesGoalsOutcomeReasonAndOrder) {
  DecisionBox box;
  const karst_decision_sink_t sink = box.sink();
  const karst_goal_t goals[] = {good(), good()};
  karst_error_t e{};
  EXPECT_EQ(sink.add_goals(&sink, goals, 2, &e), KARST_OK);
  EXPECT_EQ(sink.set_outcome(&sink, KARST_OUTCOME_GOALS, KARST_DECISION_TOUR, {"round", 5}, &e), KARST_OK);
  EXPECT_EQ(box.fault(), "");
  EXPECT_TRUE(box.is_tour());
  EXPECT_EQ(box.decision().goals.size(), 2u);
  EXPECT_EQ(box.decision().goals[1].position, core::Vec3(1, 2, 3));
  EXPECT_EQ(box.decision().reason, "round");
}

TEST(DecisionBox, ExactlyTheLimitIsTaken) {
  DecisionBox box;
  const karst_decision_sink_t sink = box.sink();
  const std::vector<karst_goal_t> goals(kMaxGoals, good());
  karst_error_t e{};
  EXPECT_EQ(sink.add_goals(&sink, goals.data(), goals.size(), &e), KARST_OK);
  EXPECT_EQ(sink.add_goals(&sink, goals.data(), 1, &e), KARST_ERROR_LIMIT);
  EXPECT_NE(box.fault(), "");
}

TEST(DecisionBox, CountThatOverflowsIsRefused) {
  DecisionBox box;
  const karst_decision_sink_t sink = box.sink();
  const karst_goal_t g = good();
  karst_error_t e{};
  EXPECT_EQ(sink.add_goals(&sink, &g, 1, &e), KARST_OK);
  EXPECT_EQ(sink.add_goals(&sink, &g, ~std::uint64_t{0}, &e), KARST_ERROR_LIMIT);
  EXPECT_EQ(sink.add_goals(&sink, nullptr, 1, &e), KARST_ERROR_ARGUMENT);
}

TEST(DecisionBox, UnknownOutcomeAndSecondOutcomeAreFaults) {
  for (const karst_outcome_t first : {karst_outcome_t{0}, karst_outcome_t{5}}) {
    DecisionBox box;
    const karst_decision_sink_t sink = box.sink();
    EXPECT_EQ(sink.set_outcome(&sink, first, 0, {nullptr, 0}, nullptr), KARST_ERROR_ARGUMENT);
    EXPECT_NE(box.fault(), "");
  }
  DecisionBox box;
  const karst_decision_sink_t sink = box.sink();
  sink.set_outcome(&sink, KARST_OUTCOME_HOLD, 0, {nullptr, 0}, nullptr);
  EXPECT_EQ(box.fault(), "");
  sink.set_outcome(&sink, KARST_OUTCOME_GO_HOME, 0, {nullptr, 0}, nullptr);
  EXPECT_EQ(box.fault(), "it set an outcome twice");
}

}  // namespace
}  // namespace karst::host
