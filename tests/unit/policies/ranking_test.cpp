// What the greedy policies share, with a policy of the test's own.
#include <gtest/gtest.h>

#include <karst/ranking.h>
#include <karst/testing/bench.h>

namespace {

class Plain : public karst::Policy {
  void parameters(karst::Parameters& p) override { ranking_.parameters(p); }
  karst::Decision decide(const karst::Request& r) override {
    return ranking_.decide(r, [](const karst::Frontier& f) {
      return karst::Merit{0.0, std::to_string(f.id)};
    });
  }
  void on_event(const karst::Event& e) override { ranking_.on_event(e); }
  karst::Ranking ranking_;
};

}  // namespace

KARST_POLICY(Plain, "plain", "0.0.1", "The nearest.")

namespace {

using karst::Decision;
using karst::testing::Bench;
using karst::testing::DrawnMap;

struct Corridor {
  DrawnMap map{1.0, {"?a.......s.......b?"}};
  Bench bench;
  Corridor() : Corridor(Bench::Values{}) {}
  explicit Corridor(const Bench::Values& values) : bench(karst_plugin_entry(), map, values) {
    bench.position = map.place('s');
    bench.direction_of_flight = {0, 1, 0};
    bench.offer(1, map.place('a'), map.place('a'));
    bench.offer(2, map.place('b'), map.place('b'));
  }
  karst_outcome_t outcome() { return bench.decide().outcome; }
};

TEST(Ranking, EqualGoalsDoNotTakeTurns) {
  Corridor c;
  int changes = 0;
  std::uint32_t last = 0;
  for (int i = 0; i < 40; ++i) {
    // The vehicle's place wavers about the middle; whichever is nearer changes each time.
    const double x = c.map.place('s').x + (i % 2 == 0 ? 0.4 : -0.4);
    for (karst::Frontier& f : c.bench.frontiers) f.path_length_m = std::abs(f.viewpoint.x - x);
    const Decision d = c.bench.decide();
    changes += last != 0 && d.goals.at(0).frontier_id != last;
    last = d.goals.at(0).frontier_id;
    c.bench.last_goal = d.goals[0].position;
    c.bench.last_fate = KARST_FATE_UNDER_WAY;
  }
  EXPECT_EQ(changes, 0);
}

TEST(Ranking, AClearlyBetterGoalStillReplacesTheOneUnderWay) {
  Corridor c;
  c.bench.last_goal = c.map.place('a');
  c.bench.last_fate = KARST_FATE_UNDER_WAY;
  EXPECT_EQ(c.bench.decide().goals.at(0).frontier_id, 1u);
  c.bench.frontiers[1].path_length_m = 1.5;
  EXPECT_EQ(c.bench.decide().goals.at(0).frontier_id, 2u);
}

TEST(Ranking, SmallClustersAndPlacesUnderTheVehicleAreIgnored) {
  Corridor c(Bench::Values{{"min_cells", "10"}});
  c.bench.frontiers[0].cells = 9;
  c.bench.frontiers[1].viewpoint = c.bench.position;
  EXPECT_EQ(c.outcome(), karst_outcome_t{KARST_OUTCOME_HOLD});
}

TEST(Ranking, ExploredOnlyWhenNothingIsLeftForAWhile) {
  Corridor c(Bench::Values{{"patience", "3"}});
  const std::vector<karst::Frontier> all = c.bench.frontiers;
  c.bench.frontiers.clear();
  EXPECT_EQ(c.outcome(), karst_outcome_t{KARST_OUTCOME_HOLD});
  c.bench.time_s = 2.9;
  EXPECT_EQ(c.outcome(), karst_outcome_t{KARST_OUTCOME_HOLD});
  c.bench.time_s = 2.95;
  c.bench.frontiers = all;
  EXPECT_EQ(c.outcome(), karst_outcome_t{KARST_OUTCOME_GOALS}) << "the clock starts anew";
  c.bench.frontiers.clear();
  c.bench.time_s = 4;
  EXPECT_EQ(c.outcome(), karst_outcome_t{KARST_OUTCOME_HOLD});
  c.bench.time_s = 7.1;
  EXPECT_EQ(c.outcome(), karst_outcome_t{KARST_OUTCOME_EXPLORED});
}

TEST(Ranking, RefusedGoalIsLeftAloneForAWhileAndLongerEachTime) {
  Corridor c;
  c.bench.frontiers.pop_back();
  const karst::Goal goal = c.bench.decide().goals.at(0);
  double pause = 4.0;
  for (int n = 0; n < 3; ++n, pause *= 2) {
    c.bench.tell(KARST_EVENT_GOAL_REJECTED, goal, "too narrow");
    c.bench.time_s += pause - 0.1;
    EXPECT_EQ(c.outcome(), karst_outcome_t{KARST_OUTCOME_HOLD}) << n;
    c.bench.time_s += 0.2;
    EXPECT_EQ(c.outcome(), karst_outcome_t{KARST_OUTCOME_GOALS}) << n;
  }
  c.bench.tell(KARST_EVENT_GOAL_UNREACHABLE, goal);
  c.outcome();
  c.bench.time_s += 1000;
  EXPECT_EQ(c.outcome(), karst_outcome_t{KARST_OUTCOME_EXPLORED}) << "four times in vain are enough";
}

TEST(Ranking, FrontierStillThereAfterAVisitYieldsToAnotherAndIsGivenUpInTheEnd) {
  Corridor c;
  c.bench.frontiers[0].path_length_m = 5.0;  // nearer than b at 8 m
  const karst::Goal a = c.bench.decide().goals.at(0);
  ASSERT_EQ(a.frontier_id, 1u);
  c.bench.tell(KARST_EVENT_GOAL_REACHED, a);
  EXPECT_EQ(c.bench.decide().goals.at(0).frontier_id, 2u);
  c.bench.tell(KARST_EVENT_GOAL_REACHED, a);
  c.bench.tell(KARST_EVENT_GOAL_REACHED, a);
  const Decision d = c.bench.decide();
  ASSERT_EQ(d.goals.size(), 1u);
  EXPECT_EQ(d.goals[0].frontier_id, 2u);
}

TEST(Ranking, ProposesAtMostSoManyGoalsBestFirst) {
  Corridor c(Bench::Values{{"goals", "3"}});
  for (std::uint32_t id = 3; id < 20; ++id)
    c.bench.offer(id, c.map.place('b') - karst::Vec3(1 + 0.2 * id, 0, 0), c.map.place('b'));
  const Decision d = c.bench.decide();
  ASSERT_EQ(d.goals.size(), 3u);
  EXPECT_GE(d.goals[0].score, d.goals[1].score);
  EXPECT_GE(d.goals[1].score, d.goals[2].score);
}

TEST(Ranking, OrderOfTheFrontiersDoesNotMatter) {
  Corridor a, b;
  std::swap(b.bench.frontiers[0], b.bench.frontiers[1]);
  const Decision da = a.bench.decide(), db = b.bench.decide();
  ASSERT_EQ(da.goals.size(), db.goals.size());
  for (std::size_t i = 0; i < da.goals.size(); ++i)
    EXPECT_EQ(da.goals[i].frontier_id, db.goals[i].frontier_id);
}

TEST(Bench, RefusesAParameterThePolicyDoesNotDeclare) {
  EXPECT_THROW(Corridor(Bench::Values{{"no_such_thing", "1"}}), karst::Error);
}

}  // namespace
