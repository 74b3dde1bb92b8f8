#include "core_stack/mission/decision/decision_cycle.h"

#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "tests/unit/mission/mapped_world.h"

namespace karst::core {
namespace {

/// Keeps what it was asked and told; proposes the viewpoint of the first frontier.
struct FirstFrontier final : PolicyPort {
  std::vector<DecisionRequest> asked;
  std::vector<PolicyEvent> told;
  std::string name() const override { return "first frontier"; }
  Decision decide(const DecisionRequest& r) override {
    asked.push_back(r);
    Decision d;
    if (r.frontiers.empty()) return d;
    d.outcome = Outcome::goals;
    d.goals.resize(1);
    d.goals[0].position = r.frontiers[0].viewpoint;
    d.goals[0].frontier_id = r.frontiers[0].cluster->id;
    return d;
  }
  void notify(const PolicyEvent& e) override { told.push_back(e); }
};

struct Deciding {
  FirstFrontier policy;
  VehicleDescription vehicle = lidar_vehicle_at_start();
  WorldModel world;
  TeamMembership alone;
  HomeEstimator home;
  DecisionCycle cycle;
  CycleInput input;

  explicit Deciding(const CoreOptions& options = {})
      : world(options, vehicle),
        home(options, vehicle, world, alone),
        cycle(options, vehicle, policy, world, home) {
    world.integrate(rays_of(room_open_to_x()));
    input.from = input.state.position = Vec3(3, 3, 2);
    input.seconds_left = 600;
    input.now = 100 * kSecond;
  }
};

TEST(DecisionCycle, AsksForAGoalAmongTheFrontiersAndPlansToIt) {
  Deciding d;
  const CycleResult first = d.cycle.decide(d.input, {}), second = d.cycle.decide(d.input, {});
  ASSERT_TRUE(first.goal && second.goal);
  EXPECT_EQ(first.outcome, Outcome::goals);
  EXPECT_EQ(first.policy, "first frontier");
  EXPECT_EQ(first.goals_proposed, 1u);
  EXPECT_EQ(first.path.points.front(), d.input.from);
  EXPECT_LT((first.path.points.back() - first.goal->position).norm(), 0.2);
  ASSERT_EQ(d.policy.asked.size(), 2u);
  EXPECT_EQ(d.policy.asked[0].sequence, 1u);
  EXPECT_EQ(d.policy.asked[1].sequence, 2u);
  EXPECT_EQ(d.policy.asked[0].map, &d.world.map());
  EXPECT_NEAR(d.policy.asked[0].seconds_before_homing, d.home.slack_s(600, d.home.estimate(d.input.from, 0)),
              1e-9);
  ASSERT_EQ(first.frontiers.size(), d.policy.asked[0].frontiers.size());
  for (std::size_t i = 0; i < first.frontiers.size(); ++i)
    EXPECT_EQ(first.frontiers[i].id, d.policy.asked[0].frontiers[i].cluster->id);
}

TEST(DecisionCycle, TellsThePolicyOfBatteryAndMissionTime) {
  Deciding d;
  d.input.battery_fraction = 0.6;
  d.input.battery_seconds_left = 600;
  d.input.mission_seconds_left = 3500;
  d.cycle.decide(d.input, {});
  ASSERT_EQ(d.policy.asked.size(), 1u);
  EXPECT_EQ(d.policy.asked[0].battery_fraction, 0.6);
  EXPECT_EQ(d.policy.asked[0].battery_seconds_left, 600);
  EXPECT_EQ(d.policy.asked[0].mission_seconds_left, 3500);
  EXPECT_EQ(d.policy.asked[0].max_acceleration_mps2, CoreOptions{}.motion.max_acceleration_mps2);
}

TEST(DecisionCycle, TellsThePolicyOfTheSurveyIfTheMissionSaysSo) {
  CoreOptions options;
  const PassageSize size;
  options.survey.passages =
      std::make_shared<const SurveyedPassages>(SurveyPrior{{{0, 3, 2}, {4, 3, 2}}, {{0, 1, size, size}}, {}});
  for (const bool told : {true, false}) {
    options.survey.told_to_policy = told;
    Deciding d(options);
    d.cycle.decide(d.input, {});
    ASSERT_EQ(d.policy.asked.size(), 1u);
    EXPECT_EQ(d.policy.asked[0].survey, told ? options.survey.passages.get() : nullptr);
  }
  Deciding without;
  without.cycle.decide(without.input, {});
  EXPECT_EQ(without.policy.asked[0].survey, nullptr);
}

TEST(DecisionCycle, AFrontierThatWasLookedAtRests) {
  Deciding d;
  const CycleResult first = d.cycle.decide(d.input, {});
  ASSERT_TRUE(first.goal);
  d.input.looked_at = {first.goal->frontier_id, 9999};
  d.cycle.decide(d.input, {});
  for (const FrontierOffer& o : d.policy.asked[1].frontiers)
    EXPECT_NE(o.cluster->id, first.goal->frontier_id);
}

TEST(DecisionCycle, WhatIsAppendedIsForAnotherFrontier) {
  Deciding d;
  const CycleResult first = d.cycle.decide(d.input, {});
  ASSERT_TRUE(first.goal);
  d.input.last_goal = first.goal;
  EXPECT_EQ(d.cycle.decide(d.input, {}).goal->frontier_id, first.goal->frontier_id);
  d.input.appending = true;
  const CycleResult appended = d.cycle.decide(d.input, {});
  ASSERT_TRUE(appended.goal);
  EXPECT_NE(appended.goal->frontier_id, first.goal->frontier_id);
}

TEST(DecisionCycle, OtherVehiclesClaimsAreNotOffered) {
  Deciding d;
  const CycleResult alone = d.cycle.decide(d.input, {});
  const Vec3 claimed = d.policy.asked[0].frontiers[0].cluster->centroid;
  const CycleResult in_team = d.cycle.decide(d.input, {{claimed}, 0.1});
  ASSERT_TRUE(alone.goal && in_team.goal);
  EXPECT_NE(alone.goal->frontier_id, in_team.goal->frontier_id);
}

TEST(DecisionCycle, AnAbandonedGoalsPlaceIsClosedAndThePolicyIsTold) {
  Deciding d;
  const CycleResult first = d.cycle.decide(d.input, {});
  ASSERT_TRUE(first.goal);
  d.cycle.tell({{PolicyEvent::Kind::goal_abandoned, 0, *first.goal, "no progress"}}, d.input.now);
  ASSERT_EQ(d.policy.told.size(), 1u);
  EXPECT_EQ(d.policy.told[0].reason, "no progress");
  d.cycle.decide(d.input, {});
  for (const FrontierOffer& o : d.policy.asked[1].frontiers)
    EXPECT_GE((o.viewpoint - first.goal->position).norm(), 0.8);
}

TEST(DecisionCycle, AClusterLivesUntilMostOfItHasBeenSeen) {
  Deciding d;
  const CycleResult first = d.cycle.decide(d.input, {});
  ASSERT_TRUE(first.goal);
  const std::uint32_t id = first.goal->frontier_id;
  EXPECT_TRUE(d.cycle.cluster_alive(id));
  EXPECT_FALSE(d.cycle.cluster_alive(9999));
  // Rock covers the cluster, but for its first cells.
  const std::vector<CellKey> cells = d.world.frontiers().clusters().at(id).cells;
  VoxelMap rock{MapOptions{}};
  for (std::size_t i = cells.size() / 5; i < cells.size(); ++i) rock.assign(cells[i], 1, 1.0f);
  for (int i = 0; i < 4; ++i) d.world.integrate(rays_of(rock));
  EXPECT_FALSE(d.cycle.cluster_alive(id));
}

TEST(DecisionCycle, NarrowPassagesAreOfferedWhenTheUsualOnesHaveNothingLeft) {
  Deciding d(narrow_passages_allowed());
  EXPECT_TRUE(d.cycle.decide(d.input, {}).goal);
  ASSERT_EQ(d.policy.asked.size(), 1u);
  EXPECT_EQ(d.policy.asked[0].clearance_m, 0.6);
  for (const auto& [id, cluster] : d.world.frontiers().clusters()) {
    Goal goal;
    goal.position = cluster.centroid;
    d.cycle.tell({{PolicyEvent::Kind::goal_abandoned, 0, goal, "nothing there"}}, d.input.now);
  }
  d.cycle.decide(d.input, {});
  ASSERT_EQ(d.policy.asked.size(), 2u) << "the usual ones were not worth a question";
  EXPECT_NEAR(d.policy.asked[1].clearance_m, 0.38, 1e-9);
  d.input.appending = true;
  d.cycle.decide(d.input, {});
  EXPECT_EQ(d.policy.asked.back().clearance_m, 0.6) << "what is under way may show more";
}

}  // namespace
}  // namespace karst::core
