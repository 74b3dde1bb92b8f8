#include "core_stack/mission/decision/chosen_frontiers.h"

#include <gtest/gtest.h>

namespace karst::core {
namespace {

const Vec3 kPlace(1, 1, 1);

FrontierCluster cluster(std::uint32_t id, std::size_t cells, const Vec3& centroid) {
  FrontierCluster c;
  c.id = id;
  c.cells.resize(cells);
  c.centroid = centroid;
  return c;
}

TEST(ChosenFrontiers, AreWorthFlyingToUntilThreeQuartersOfTheirCellsAreSeen) {
  ChosenFrontiers chosen;
  EXPECT_TRUE(chosen.worth_flying_to(cluster(1, 1, kPlace))) << "never chosen";
  chosen.note(cluster(1, 40, kPlace));
  for (std::size_t cells = 1; cells <= 60; ++cells)
    EXPECT_EQ(chosen.worth_flying_to(cluster(1, cells, kPlace)), 4 * cells >= 40) << cells;
  EXPECT_TRUE(chosen.worth_flying_to(cluster(2, 1, kPlace))) << "another one";
}

TEST(ChosenFrontiers, AreRememberedWhereTheyWereChosenLast) {
  ChosenFrontiers chosen;
  EXPECT_FALSE(chosen.centroid(1));
  chosen.note(cluster(1, 40, Vec3(1, 2, 3)));
  chosen.note(cluster(2, 40, Vec3(7, 7, 7)));
  chosen.note(cluster(1, 8, Vec3(2, 2, 3)));
  EXPECT_EQ(chosen.centroid(1), Vec3(2, 2, 3));
  EXPECT_TRUE(chosen.worth_flying_to(cluster(1, 2, kPlace)));
}

}  // namespace
}  // namespace karst::core
