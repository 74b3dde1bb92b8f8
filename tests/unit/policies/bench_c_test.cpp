// The test kit in C against the one in C++: a policy in C, asked by both.
#include <karst/testing/bench_c.h>

#include <gtest/gtest.h>

#include <karst/policy.h>
#include <karst/testing/bench.h>

#include <cmath>
#include <memory>
#include <string>

namespace {

using karst::testing::Bench;
using karst::testing::DrawnMap;

constexpr const char* kLower =
    "#####\n"
    "#a.b#\n"
    "#####\n";
constexpr const char* kUpper =
    "#####\n"
    "#..c?\n"
    "#####\n";
const std::string kDrawing = std::string(kLower) + "  \n" + kUpper;

struct Destroy {
  void operator()(karst_bench_t* bench) const { karst_bench_destroy(bench); }
};
using BenchC = std::unique_ptr<karst_bench_t, Destroy>;

BenchC bench_c(const std::string& drawing, const char* parameters = nullptr) {
  karst_error_t e{};
  BenchC bench(karst_bench_create(karst_plugin_entry(), drawing.c_str(), 0.5, parameters, &e));
  EXPECT_TRUE(bench != nullptr) << e.text;
  return bench;
}
void stand_at(karst_bench_t* bench, char letter) {
  karst_bench_state_t state = karst_bench_get_state(bench);
  state.position = karst_bench_place(bench, letter);
  karst_bench_set_state(bench, &state);
}
void offer_all(karst_bench_t* bench) {
  std::uint32_t id = 0;
  for (const char letter : {'a', 'b', 'c'}) {
    const karst_vec3_t at = karst_bench_place(bench, letter);
    karst_bench_offer(bench, ++id, at, at, 20);
  }
}

TEST(BenchC, AsksAsTheBenchInCppDoes) {
  Bench cpp(karst_plugin_entry(), DrawnMap(0.5, {kLower, kUpper}));
  const BenchC c = bench_c(kDrawing);
  const DrawnMap& map = cpp.host().map();
  cpp.position = cpp.start = map.place('c');
  karst_bench_state_t state = karst_bench_get_state(c.get());
  EXPECT_EQ(state.seconds_before_homing, cpp.seconds_before_homing);
  EXPECT_EQ(state.battery_fraction, cpp.battery_fraction);
  EXPECT_EQ(state.battery_seconds_left, cpp.battery_seconds_left);
  EXPECT_EQ(state.mission_seconds_left, cpp.mission_seconds_left);
  state.position = state.start = karst_bench_place(c.get(), 'c');
  state.time_s = 3;
  karst_bench_set_state(c.get(), &state);
  EXPECT_EQ(karst_bench_get_state(c.get()).time_s, 3);
  std::uint32_t id = 0;
  for (const char letter : {'a', 'b', 'c'}) cpp.offer(++id, map.place(letter), map.place(letter));
  offer_all(c.get());
  const karst::Decision expected = cpp.decide();
  karst_error_t e{};
  ASSERT_EQ(karst_bench_decide(c.get(), &e), KARST_OK) << e.text;
  EXPECT_EQ(karst_bench_outcome(c.get()), expected.outcome);
  EXPECT_EQ(karst_bench_is_tour(c.get()), 0);
  EXPECT_STREQ(karst_bench_reason(c.get()), "");
  ASSERT_EQ(karst_bench_goal_count(c.get()), expected.goals.size());
  const karst_goal_t goal = karst_bench_goal(c.get(), 0);
  EXPECT_EQ(goal.frontier_id, expected.goals.at(0).frontier_id);
  EXPECT_EQ(karst::distance(goal.position, expected.goals[0].position), 0);
  EXPECT_EQ(goal.score, expected.goals[0].score);
  EXPECT_EQ(karst_bench_why(c.get(), 0), expected.goals[0].why);
  EXPECT_EQ(karst::from_abi(goal.why), expected.goals[0].why);
}

TEST(BenchC, TellsOfEventsAndMovesTheVehicle) {
  const BenchC c = bench_c(kDrawing);
  karst_error_t e{};
  EXPECT_NE(karst_bench_arrive(c.get(), &e), KARST_OK) << "there is no goal yet";
  EXPECT_STREQ(e.text, "the last answer had no goal");
  stand_at(c.get(), 'c');
  offer_all(c.get());
  ASSERT_EQ(karst_bench_decide(c.get(), nullptr), KARST_OK);
  const karst_vec3_t goal = karst_bench_goal(c.get(), 0).position;
  EXPECT_EQ(karst_bench_fail(c.get(), KARST_EVENT_GOAL_REJECTED, "no", nullptr), KARST_OK);
  EXPECT_EQ(karst_bench_arrive(c.get(), nullptr), KARST_OK);
  EXPECT_EQ(karst::distance(karst_bench_get_state(c.get()).position, goal), 0);
}

TEST(BenchC, OffersWhatTheDrawingShows) {
  const BenchC c = bench_c("#######\n#s...a?\n#######\n");
  stand_at(c.get(), 's');
  karst_bench_offer_drawn(c.get(), 1);
  ASSERT_EQ(karst_bench_decide(c.get(), nullptr), KARST_OK);
  ASSERT_EQ(karst_bench_goal_count(c.get()), 1u);
  EXPECT_EQ(karst::distance(karst_bench_goal(c.get(), 0).position, karst_bench_place(c.get(), 'a')), 0);
  karst_bench_clear_frontiers(c.get());
  ASSERT_EQ(karst_bench_decide(c.get(), nullptr), KARST_OK);
  EXPECT_EQ(karst_bench_outcome(c.get()), karst_outcome_t{KARST_OUTCOME_EXPLORED});
  EXPECT_STREQ(karst_bench_reason(c.get()), "no frontier can be reached");
}

/// Says how many passages it sees.
class PassageCounter : public karst::Policy {
  karst::Decision decide(const karst::Request& r) override {
    return karst::Decision::hold(std::to_string(r.map.passages().passages.size()));
  }
};

TEST(BenchC, PassagesAreThoseOfTheDrawingFromTheStart) {
  static const auto policy = [](std::uint32_t) noexcept {
    return karst::border::entry<PassageCounter>("counter", "1.0.0", "Counts passages.");
  };
  static const karst_plugin_t plugin{sizeof plugin, KARST_ABI_MAJOR, KARST_ABI_MINOR, 1, policy};
  const BenchC c(karst_bench_create(&plugin, "#######\n#s...a?\n#######\n", 1, nullptr, nullptr));
  ASSERT_TRUE(c != nullptr);
  karst_bench_state_t state = karst_bench_get_state(c.get());
  state.start = state.position = karst_bench_place(c.get(), 's');
  karst_bench_set_state(c.get(), &state);
  ASSERT_EQ(karst_bench_decide(c.get(), nullptr), KARST_OK);
  EXPECT_STREQ(karst_bench_reason(c.get()), "1");
  state.start.x = 1000;
  karst_bench_set_state(c.get(), &state);
  ASSERT_EQ(karst_bench_decide(c.get(), nullptr), KARST_OK);
  EXPECT_STREQ(karst_bench_reason(c.get()), "0") << "no free cell is near the start";
}

TEST(BenchC, WhatIsNotThereIsEmpty) {
  const BenchC c = bench_c(kDrawing);
  EXPECT_TRUE(std::isnan(karst_bench_place(c.get(), 'z').x));
  EXPECT_EQ(karst_bench_outcome(c.get()), 0u) << "nothing was asked yet";
  EXPECT_EQ(karst_bench_goal_count(c.get()), 0u);
  EXPECT_EQ(karst_bench_goal(c.get(), 7).frontier_id, 0u);
  EXPECT_STREQ(karst_bench_why(c.get(), 7), "");
  EXPECT_EQ(karst_bench_log_count(c.get()), 0u);
  EXPECT_STREQ(karst_bench_log(c.get(), 0), "");
  EXPECT_EQ(karst_bench_drawing_count(c.get()), 0u);
  karst_bench_destroy(nullptr);
}

TEST(BenchC, BadInputIsRefusedWithAReason) {
  const auto fault = [](const char* drawing, double resolution_m, const char* parameters) {
    karst_error_t e{};
    EXPECT_EQ(karst_bench_create(karst_plugin_entry(), drawing, resolution_m, parameters, &e), nullptr);
    EXPECT_NE(e.code, KARST_OK);
    return std::string(e.text);
  };
  EXPECT_EQ(fault("a$b", 1, ""), "a drawn map holds '#', '.', '?' and letters, not '$'");
  EXPECT_EQ(fault("a", 0, ""), "the resolution is not greater than 0 m");
  EXPECT_EQ(fault("a", std::nan(""), ""), "the resolution is not greater than 0 m");
  EXPECT_EQ(fault("a", 1, "max_path"), "expected id=value, got \"max_path\"");
  EXPECT_EQ(fault("a", 1, "no_such=1"), "the policy declares no parameter no_such");
}

TEST(BenchC, ParametersReachThePolicy) {
  const BenchC c = bench_c("#######\n#s...a#\n#######\n", " max_path=1.5  ");
  stand_at(c.get(), 's');
  const karst_vec3_t a = karst_bench_place(c.get(), 'a');
  karst_bench_offer(c.get(), 1, a, a, 20);
  ASSERT_EQ(karst_bench_decide(c.get(), nullptr), KARST_OK);
  EXPECT_EQ(karst_bench_outcome(c.get()), karst_outcome_t{KARST_OUTCOME_EXPLORED}) << "it is 2 m away";
}

}  // namespace
