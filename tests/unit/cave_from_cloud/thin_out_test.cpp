// Thinning against brute force.
#include "sdk/cave_from_cloud/thin_out.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/unit/cave_from_cloud/scans.h"

namespace karst::from_cloud {
namespace {

using core::Random;
using core::Vec3;
using core::Vec3f;

PointCloud random_cloud(std::size_t count, double half_m, std::uint64_t seed) {
  Random random(seed);
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const auto coordinate = [&] { return static_cast<float>(random.uniform(-half_m, half_m)); };
    const float x = coordinate(), y = coordinate(), z = coordinate();
    cloud.points.emplace_back(x, y, z);
  }
  return cloud;
}

TEST(ThinOut, LeavesTheMeanOfThePointsOfEachCell) {
  PointCloud cloud = random_cloud(3000, 2, 3);
  cloud.origin = Vec3(1, 2, 3);
  Random random(4);
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    cloud.normals.push_back((Vec3(0, 0, 5) + test::random_unit(random)).normalized().cast<float>());
  struct Sums {
    Vec3 places = Vec3::Zero(), normals = Vec3::Zero();
    double count = 0;
  };
  std::map<std::array<double, 3>, Sums> cells;
  const double voxel_m = 0.5;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Vec3 p = cloud.points[i].cast<double>();
    Sums& cell =
        cells[{std::floor(p.x() / voxel_m), std::floor(p.y() / voxel_m), std::floor(p.z() / voxel_m)}];
    cell.places += p;
    cell.normals += cloud.normals[i].cast<double>();
    cell.count += 1;
  }
  const PointCloud thin = thinned(cloud, voxel_m);
  EXPECT_EQ(thin.origin, cloud.origin);
  ASSERT_EQ(thin.points.size(), cells.size());
  ASSERT_EQ(thin.normals.size(), cells.size());
  for (std::size_t i = 0; i < thin.points.size(); ++i) {
    const Vec3 p = thin.points[i].cast<double>();
    const Sums& cell =
        cells.at({std::floor(p.x() / voxel_m), std::floor(p.y() / voxel_m), std::floor(p.z() / voxel_m)});
    EXPECT_LT((p - cell.places / cell.count).norm(), 1e-5);
    EXPECT_LT((thin.normals[i].cast<double>() - cell.normals.normalized()).norm(), 1e-5);
  }
}

TEST(ThinOut, NormalsThatCancelLeaveNone) {
  PointCloud cloud;
  cloud.points = {{0.1f, 0.1f, 0.1f}, {0.2f, 0.1f, 0.1f}};
  cloud.normals = {{0, 0, 1}, {0, 0, -1}};
  EXPECT_EQ(thinned(cloud, 1).normals, std::vector<Vec3f>{Vec3f(0, 0, 0)});
}

TEST(ThinOut, GroupsThatAreFewAndFarFromTheOthersGo) {
  PointCloud cloud = random_cloud(400, 3, 8);
  const double gap_m = 0.6;
  const std::size_t least = 6;
  // Brute force: spread from each point over all that are near.
  std::vector<Vec3f> kept;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    std::vector<bool> met(cloud.points.size(), false);
    std::vector<std::size_t> group{i};
    met[i] = true;
    for (std::size_t k = 0; k < group.size(); ++k)
      for (std::size_t j = 0; j < cloud.points.size(); ++j)
        if (!met[j] && static_cast<double>((cloud.points[j] - cloud.points[group[k]]).norm()) < gap_m) {
          met[j] = true;
          group.push_back(j);
        }
    if (group.size() >= least) kept.push_back(cloud.points[i]);
  }
  ASSERT_GT(kept.size(), 20u);
  ASSERT_LT(kept.size(), 380u);
  EXPECT_EQ(without_lonely(cloud, gap_m, least).points, kept);
}

TEST(ThinOut, TheSpacingOfALatticeIsItsStep) {
  for (const float step : {0.1f, 0.37f, 2.0f}) {
    PointCloud cloud;
    for (int x = 0; x < 40; ++x)
      for (int y = 0; y < 40; ++y)
        cloud.points.emplace_back(step * static_cast<float>(x), step * static_cast<float>(y), 0.0f);
    EXPECT_NEAR(spacing_m(cloud), static_cast<double>(step), 1e-4);
  }
}

TEST(ThinOut, PointsUponOneAnotherCountAsOne) {
  PointCloud cloud;
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y)
      for (int k = 0; k < 10; ++k)
        cloud.points.emplace_back(static_cast<float>(x) + 1e-3f * static_cast<float>(k),
                                  static_cast<float>(y), 0.5f);
  EXPECT_NEAR(spacing_m(cloud), 1, 0.02);
  cloud.points.resize(1);
  EXPECT_EQ(spacing_m(cloud), 0) << "of a single point";
}

}  // namespace
}  // namespace karst::from_cloud
