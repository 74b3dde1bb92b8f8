#include "sdk/preflight/plan_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace karst::preflight {
namespace {

evaluation::CellSet cells_of(const std::vector<core::CellKey>& keys) {
  core::CellKey low = keys.front(), high = keys.front();
  for (const core::CellKey& k : keys) {
    low = {std::min(low.x, k.x), std::min(low.y, k.y), std::min(low.z, k.z)};
    high = {std::max(high.x, k.x), std::max(high.y, k.y), std::max(high.z, k.z)};
  }
  evaluation::CellSet cells(low, high);
  for (const core::CellKey& k : keys) cells.insert(k);
  return cells;
}

TEST(PlanView, JoinsColumnsSideBySideWhateverTheirHeight) {
  const PlanView plan = plan_view(
      cells_of({{-1, 0, 5}, {0, 0, 0}, {0, 0, 9}, {1, 0, 2}, {4, 0, 0}, {4, 1, 0}}), 0.2, {0.1, 0.1, 1});
  ASSERT_EQ(plan.runs.size(), 3u);
  EXPECT_EQ(plan.edge_m, 0.2);
  const auto is = [&](std::size_t i, int x, int y, int length) {
    return plan.runs[i].x == x && plan.runs[i].y == y && plan.runs[i].length == length;
  };
  EXPECT_TRUE(is(0, -1, 0, 3));
  EXPECT_TRUE(is(1, 4, 0, 1));
  EXPECT_TRUE(is(2, 4, 1, 1));
}

TEST(PlanView, JoinsColumnsOfLargeCaves) {
  std::vector<core::CellKey> keys;
  for (int y = -1000; y < 1000; ++y) keys.push_back({0, y, 0});
  const PlanView plan = plan_view(cells_of(keys), 0.2, {0, 0, 0});
  EXPECT_LE(plan.runs.size(), 401u);
  EXPECT_GE(plan.runs.size(), 300u);
  EXPECT_NEAR(plan.edge_m * static_cast<double>(plan.runs.size()), 400, 2);
}

TEST(PlanView, NorthIsUpAndTheStartIsWhereItIs) {
  // 10 m to the east, 5 m to the north; the start is 1 m from the west and 1 m from the south.
  PlanView plan;
  plan.edge_m = 1;
  for (int y = 0; y < 5; ++y) plan.runs.push_back({0, y, 10});
  plan.start = core::Vec3(1, 1, 0);
  const std::string svg = to_svg(plan);
  EXPECT_NE(svg.find("M0 4h10v1h-10z"), std::string::npos) << "the southern row is the lowest: " << svg;
  EXPECT_NE(svg.find("cx=\"1.00\" cy=\"4.00\""), std::string::npos) << svg;
  EXPECT_NE(svg.find(">2 m</text>"), std::string::npos) << "a bar of at most a third of the width: " << svg;
}

TEST(PlanView, OfNothingIsNothing) {
  EXPECT_TRUE(plan_view({}, 0.2, {0, 0, 0}).runs.empty());
  EXPECT_EQ(to_svg(PlanView{}), "");
}

}  // namespace
}  // namespace karst::preflight
