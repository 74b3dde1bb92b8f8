#include "core_stack/common/direction_cells.h"

#include <gtest/gtest.h>

#include <set>

#include "core_stack/common/random.h"

namespace karst::core {
namespace {

std::vector<Vec3f> random_directions(std::size_t n) {
  Random random(5);
  std::vector<Vec3f> out;
  while (out.size() < n)
    out.push_back(Vec3(random.normal(), random.normal(), random.normal()).normalized().cast<float>());
  for (const Vec3f& pole : {Vec3f(0, 0, 1), Vec3f(0, 0, -1), Vec3f(-1, 0, 0), Vec3f(-1, -1e-9f, 0)})
    out.push_back(pole);
  return out;
}

// Independent reference: every pair.
TEST(DirectionCells, RunsHoldEveryDirectionInReachOnce) {
  const std::vector<Vec3f> directions = random_directions(1500);
  for (const float cell : {0.01f, 0.05f, 0.3f})
    for (const float radius : {0.02f, 0.1f, 0.6f}) {
      const DirectionCells cells(directions, cell);
      for (std::size_t i = 0; i < directions.size(); i += 7) {
        std::multiset<std::size_t> found;
        cells.for_each_run(directions[i], radius, [&](std::size_t first, std::size_t end) {
          for (std::size_t at = first; at < end; ++at) found.insert(cells.order()[at]);
        });
        for (std::size_t j = 0; j < directions.size(); ++j) {
          EXPECT_LE(found.count(j), 1u);
          if (std::acos(std::clamp(directions[i].dot(directions[j]), -1.0f, 1.0f)) < radius - 1e-3f) {
            EXPECT_EQ(found.count(j), 1u) << cell << " " << radius << " " << directions[i].transpose();
          }
        }
      }
    }
}

TEST(DirectionCells, CellsAreSmallAndHoldEachDirectionOnce) {
  const std::vector<Vec3f> directions = random_directions(5000);
  const DirectionCells cells(directions, 0.1f);
  std::set<std::size_t> seen;
  cells.for_each_cell([&](std::size_t first, std::size_t end) {
    ASSERT_LT(first, end);
    for (std::size_t at = first; at < end; ++at) {
      EXPECT_TRUE(seen.insert(cells.order()[at]).second);
      EXPECT_LT((directions[cells.order()[at]] - directions[cells.order()[first]]).norm(), 0.25f);
    }
  });
  EXPECT_EQ(seen.size(), directions.size());
}

TEST(DirectionCells, NoDirectionsAreNoRuns) {
  const DirectionCells cells({}, 0.1f);
  cells.for_each_cell([](std::size_t, std::size_t) { FAIL(); });
  cells.for_each_run(Vec3f::UnitX(), 1, [](std::size_t first, std::size_t end) { EXPECT_EQ(first, end); });
}

}  // namespace
}  // namespace karst::core
