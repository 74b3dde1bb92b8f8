#include "core_stack/mission/policy/fallback_policy.h"

#include <gtest/gtest.h>

#include <limits>

namespace karst::core {
namespace {

TEST(FallbackPolicy, RanksReachableFrontiersByPathLength) {
  std::vector<FrontierCluster> clusters(4);
  DecisionRequest request;
  const double lengths[] = {7, std::numeric_limits<double>::infinity(), 2, 5};
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    clusters[i].id = static_cast<std::uint32_t>(i + 1);
    request.frontiers.push_back({&clusters[i], Vec3(lengths[i], 0, 0), 0, lengths[i]});
  }
  const Decision d = FallbackPolicy{}.decide(request);
  ASSERT_EQ(d.outcome, Outcome::goals);
  ASSERT_EQ(d.goals.size(), 3u);
  EXPECT_EQ(d.goals[0].frontier_id, 3u);
  EXPECT_EQ(d.goals[1].frontier_id, 4u);
  EXPECT_EQ(d.goals[2].frontier_id, 1u);
}

TEST(FallbackPolicy, SaysExploredWhenNothingCanBeReached) {
  FrontierCluster cluster;
  DecisionRequest request;
  request.frontiers.push_back({&cluster, Vec3::Zero(), 0, std::numeric_limits<double>::infinity()});
  EXPECT_EQ(FallbackPolicy{}.decide(request).outcome, Outcome::explored);
}

}  // namespace
}  // namespace karst::core
