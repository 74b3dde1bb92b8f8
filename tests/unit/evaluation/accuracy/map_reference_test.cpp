// The map's error point to point: samples of a mesh, and nearest points against trying all.
#include "sdk/evaluation/accuracy/map_reference.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core_stack/common/error.h"
#include "core_stack/common/random.h"
#include "core_stack/mapping/obstacles/point_tree.h"
#include "core_stack/mapping/octomap/octomap_io.h"
#include "sdk/evaluation/accuracy/map_error.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::evaluation {
namespace {

using core::Vec3;
using core::Vec3f;

/// A level square of 10 m at z = 0, in two triangles.
cave::TriangleMesh floor_mesh() {
  return {{{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

TEST(PointTree, FindsTheNearestAndThoseWithinOfAll) {
  core::Random random(8);
  std::vector<Vec3f> points;
  for (int i = 0; i < 3000; ++i)
    points.push_back(Vec3(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-3, 3)).cast<float>());
  const core::PointTree tree(points);
  for (int i = 0; i < 300; ++i) {
    const Vec3 q(random.uniform(-12, 12), random.uniform(-12, 12), random.uniform(-5, 5));
    double least = 1e9;
    std::vector<std::uint32_t> inside;
    for (std::uint32_t k = 0; k < points.size(); ++k) {
      const double d = (points[k].cast<double>() - q).norm();
      least = std::min(least, d);
      if (d < 1.5) inside.push_back(k);
    }
    EXPECT_NEAR(tree.nearest(q)->distance_m, least, 1e-6);
    EXPECT_EQ(tree.within(q, 1.5), inside);
  }
  EXPECT_FALSE(core::PointTree({}).nearest(Vec3::Zero()));
  EXPECT_FALSE(tree.nearest(Vec3::Constant(std::nan(""))));
}

TEST(OpenReference, ReadsTheMeshOfACaveFileInItsUnit) {
  const test::TemporaryDirectory folder;
  folder.write("a.obj", "v 0 0 0\nv 10000 0 0\nv 10000 0 -10000\nv 0 0 -10000\nf 1 2 3\nf 1 3 4\n");
  folder.write("a.info", "mesh a.obj\nunit mm\nup y\n");  // the floor of 10 m; a start is of no use here
  const MapReference reference =
      open_reference((folder.path() / "a.info").string(), 400, {Vec3(0, 0, 0), Vec3(10, 10, 1)});
  EXPECT_NEAR(static_cast<double>(reference.points), 40000, 1);
  EXPECT_NEAR(reference.distance_m({5, 5, 0.3}), 0.3, 0.01);
}

TEST(SampleSurface, HasTheDensityAskedForEverywhereOnTheSurface) {
  const Eigen::AlignedBox3d all(Vec3::Zero(), Vec3::Constant(10));
  const auto points = sample_surface(floor_mesh(), 400, all, 0, "floor");
  EXPECT_NEAR(static_cast<double>(points.size()), 40000, 1);
  std::array<int, 100> per_m2{};
  for (const Vec3f& p : points) {
    ASSERT_EQ(p.z(), 0.0f);
    ++per_m2[static_cast<std::size_t>(std::min(9.0f, std::floor(p.x())) * 10 +
                                      std::min(9.0f, std::floor(p.y())))];
  }
  for (const int n : per_m2) EXPECT_NEAR(n, 400, 40);
  EXPECT_EQ(points, sample_surface(floor_mesh(), 400, all, 0, "floor"));
  const Eigen::AlignedBox3d away(Vec3(50, 0, 0), Vec3(51, 1, 1));
  EXPECT_TRUE(sample_surface(floor_mesh(), 400, away, 5, "floor").empty());
  EXPECT_THROW(sample_surface(floor_mesh(), 1e6, all, 0, "floor"), core::InputError);
}

TEST(MapReference, APlantedOffsetIsTheErrorFound) {
  test::TemporaryDirectory dir;
  const std::string mesh = (dir.path() / "floor.ply").string();
  cave::write_mesh(mesh, floor_mesh());
  std::vector<Vec3> map;
  for (double x = 1; x < 9; x += 0.1)
    for (double y = 1; y < 9; y += 0.1) map.push_back({x, y, x < 5 ? 0.3 : 0.5});
  const MapReference reference = open_reference(mesh, 2500, map);
  EXPECT_EQ(reference.kind, "mesh");
  const auto e = map_evaluation(map, reference);
  EXPECT_NEAR(e["error_m"]["mean"].get<double>(), 0.4, 0.002);
  EXPECT_NEAR(e["error_m"]["std"].get<double>(), 0.1, 0.002);
  std::size_t counted = 0;
  for (const std::size_t n : e["plots"]["counts"]) counted += n;
  EXPECT_EQ(counted, map.size());
}

TEST(MapReference, OfACloudIsTheDistanceToItsPoints) {
  test::TemporaryDirectory dir;
  dir.write("scanner.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 2\nDATA ascii\n0 0 0\n10 0 0\n");
  const MapReference reference = open_reference((dir.path() / "scanner.pcd").string(), 1, {Vec3::Zero()});
  EXPECT_EQ(reference.kind, "cloud");
  EXPECT_NEAR(reference.distance_m({3, 4, 0}), 5, 1e-6);
  EXPECT_NEAR(reference.distance_m({10, 0, 2}), 2, 1e-6);
}

TEST(MapReference, SaysWhatIsNoReferenceAndNoMap) {
  test::TemporaryDirectory dir;
  EXPECT_THROW(open_reference("/nowhere.ply", 400, {Vec3::Zero()}), core::InputError);
  dir.write("empty.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 0\nDATA ascii\n");
  EXPECT_THROW(open_reference((dir.path() / "empty.pcd").string(), 400, {Vec3::Zero()}), core::InputError);
  EXPECT_THROW(read_map_points((dir.path() / "empty.pcd").string()), core::InputError);
}

TEST(ReadMapPoints, OfAnOctomapAndItsPlyAreTheSame) {
  test::TemporaryDirectory dir;
  core::VoxelMap map{core::MapOptions{}};
  for (int i = 0; i < 20; ++i) map.assign({i, 2 * i, -i}, 1, i % 3 == 0 ? -1.0f : 1.0f);
  core::write_octomap(map, (dir.path() / "map").string());
  core::write_ply(map, (dir.path() / "map.ply").string());
  const auto from_bt = read_map_points((dir.path() / "map.bt").string());
  const auto from_ply = read_map_points((dir.path() / "map.ply").string());
  ASSERT_EQ(from_bt.size(), map.occupied_cells());
  ASSERT_EQ(from_ply.size(), from_bt.size());
  for (std::size_t i = 0; i < from_bt.size(); ++i) EXPECT_LT((from_bt[i] - from_ply[i]).norm(), 1e-5);
}

}  // namespace
}  // namespace karst::evaluation
