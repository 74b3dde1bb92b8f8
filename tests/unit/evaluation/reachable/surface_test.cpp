// The surface of rooms whose cells can be counted by hand.
#include "sdk/evaluation/reachable/surface.h"

#include <gtest/gtest.h>

#include <set>

#include "core_stack/mapping/occupancy/voxel_map.h"
#include "sdk/evaluation/metrics/metrics.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::evaluation {
namespace {

using core::Vec3;

/// A closed box from -half to half.
cave::TriangleMesh box(double half) {
  cave::TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(
        (Vec3(i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half)).cast<float>());
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 7, 5}, {4, 6, 7}, {0, 5, 1}, {0, 4, 5},
                    {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  return mesh;
}

Reachable room() { return find_reachable(box(1.9), Vec3(0.1, 0.1, 0.1), {}, "room"); }

TEST(Surface, OfARoomIsItsSixWalls) {
  // Walls at 1.9 m run through the middle of cells -10 and 9; free are -9 .. 8, 18 along each edge, all seen.
  const Reachable r = room();
  ASSERT_EQ(r.reachable_cells, 18u * 18 * 18);
  const std::vector<CellKey> cells = surface_cells(r);
  EXPECT_EQ(cells.size(), 6u * 18 * 18);
  for (const CellKey& k : cells) {
    int on_wall = 0;
    for (const int v : {k.x, k.y, k.z}) on_wall += v == -10 || v == 9;
    EXPECT_EQ(on_wall, 1) << k.x << " " << k.y << " " << k.z;
  }
}

TEST(Surface, SeenIsWhatTheMapHoldsThereOrOneCellOff) {
  Truth truth;
  truth.surface = surface_cells(room());
  const auto fraction = [&](const core::VoxelMap& map) {
    test::TemporaryDirectory dir;
    return evaluate(read_run(dir.path()), &map, truth)["surface_seen"].get<double>();
  };
  core::VoxelMap map{core::MapOptions{}};
  EXPECT_EQ(fraction(map), 0);
  for (int y = -9; y < 9; ++y)
    for (int z = -9; z < 9; ++z) map.assign({-10, y, z}, 1, 2.0f);  // one wall
  // Beside it, an edge's row of each of the four neighbouring walls is one cell off.
  const double one_wall = 1.0 / 6, rows = 4 * 18 / (6.0 * 18 * 18);
  EXPECT_NEAR(fraction(map), one_wall, rows + 1e-9);
  for (int y = -9; y < 9; ++y)
    for (int z = -9; z < 9; ++z) map.assign({10, y, z}, 1, 2.0f);  // the one across, a cell too far out
  EXPECT_NEAR(fraction(map), 2 * one_wall, rows + 1e-9);
  for (int y = -9; y < 9; ++y)
    for (int x = -9; x < 9; ++x) map.assign({x, y, 11}, 1, 2.0f);  // the roof, two cells off: not seen
  EXPECT_NEAR(fraction(map), 2 * one_wall, rows + 1e-9);
}

TEST(Surface, OfARunWithoutAMapIsThatOfTheCellsThatGrew) {
  Truth truth;
  truth.surface = {{0, 0, 0}, {5, 0, 0}, {9, 0, 0}, {20, 0, 0}};
  test::TemporaryDirectory dir;
  std::string growth;
  for (const auto& [x, t] : {std::pair(0, 100), {10, 200}, {20, 300}, {20, -400}}) {
    const std::int32_t r[4] = {x, 0, 0, t};
    growth.append(reinterpret_cast<const char*>(r), sizeof r);
  }
  dir.write("map_growth.bin", growth);  // 0 hit, 9 one cell off, 20 gone again
  EXPECT_EQ(evaluate(read_run(dir.path()), nullptr, truth)["surface_seen"], 0.5);
}

}  // namespace
}  // namespace karst::evaluation
