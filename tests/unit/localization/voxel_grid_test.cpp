#include "core_stack/localization/voxel_grid.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <map>
#include <tuple>

#include "core_stack/common/random.h"

namespace {

using namespace karst::core;

std::vector<Vec3f> random_points(Random& random, std::size_t count, double half_width) {
  std::vector<Vec3f> points;
  for (std::size_t i = 0; i < count; ++i)
    points.push_back(Vec3(random.uniform(-half_width, half_width), random.uniform(-half_width, half_width),
                          random.uniform(-half_width, half_width))
                         .cast<float>());
  return points;
}

Eigen::Vector3i cell(const Vec3f& p, double voxel) {
  return (p.cast<double>() / voxel).array().floor().cast<int>();
}

/// Mean and scatter of the points in the 27 voxels around a place, one by one.
struct Oracle {
  double points = 0;
  Vec3 mean = Vec3::Zero();
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();

  Oracle(const std::vector<Vec3f>& all, const Vec3f& place, double voxel) {
    const auto inside = [&](const Vec3f& p) {
      return (cell(p, voxel) - cell(place, voxel)).cwiseAbs().maxCoeff() <= 1;
    };
    for (const Vec3f& p : all)
      if (inside(p)) ++points, mean += p.cast<double>();
    mean /= points;
    for (const Vec3f& p : all)
      if (inside(p)) {
        const Vec3 d = p.cast<double>() - mean;
        scatter += d * d.transpose() / points;
      }
  }
};

void expect_same(const Surface& s, const Oracle& o) {
  ASSERT_EQ(s.points, o.points);
  EXPECT_LT((s.mean - o.mean).norm(), 1e-5);
  const Eigen::Matrix3d scatter = s.axes * s.deviation_m.cwiseAbs2().asDiagonal() * s.axes.transpose();
  EXPECT_LT((scatter - o.scatter).norm(), 1e-5);
  EXPECT_LE(s.deviation_m[0], s.deviation_m[1]);
  EXPECT_LE(s.deviation_m[1], s.deviation_m[2]);
}

TEST(VoxelGrid, TheSurfaceOfAWindowIsThatOfItsPoints) {
  Random random(1);
  for (const double offset : {0.0, 900.0, -900.0}) {  // far from the origin as well
    std::vector<Vec3f> points = random_points(random, 3000, 1.0);
    for (Vec3f& p : points) p += Vec3f::Constant(static_cast<float>(offset));
    VoxelGrid grid(0.25, 1'000'000);
    grid.insert(points);
    for (std::size_t i = 0; i < 50; ++i) {
      const auto key = grid.key_of(points[i]);
      expect_same(surface_of(grid, key, grid.window_around(key), 3), Oracle(points, points[i], 0.25));
    }
  }
}

TEST(VoxelGrid, AGridMadeFromAFinerOneIsThatOfItsPoints) {
  Random random(2);
  const std::vector<Vec3f> points = random_points(random, 3000, 1.5);
  VoxelGrid fine(0.125, 1'000'000), coarse(0.25, 1'000'000), both(0.25, 1'000'000);
  fine.insert(points);
  coarse.merge(fine);
  both.merge(coarse), both.merge(coarse);
  for (std::size_t i = 0; i < 50; ++i) {
    const auto key = coarse.key_of(points[i]);
    expect_same(surface_of(coarse, key, coarse.window_around(key), 3), Oracle(points, points[i], 0.25));
    EXPECT_EQ(both.find(key)->sums.points, 2 * coarse.find(key)->sums.points);
  }
}

RC_GTEST_PROP(VoxelGrid, FindsWhatWasPutInAndNothingElse, (std::uint64_t seed)) {
  Random random(seed);
  const double voxel = random.uniform(0.05, 2);
  VoxelGrid grid(voxel, 5);
  std::map<std::tuple<int, int, int>, int> count;
  const std::vector<Vec3f> points = random_points(random, 500, 3);
  grid.insert(points);
  for (const Vec3f& p : points) {
    const Eigen::Vector3i c = ((p * static_cast<float>(1 / voxel)).array().floor()).cast<int>();
    ++count[{c.x(), c.y(), c.z()}];
  }
  RC_ASSERT(grid.voxels().size() == count.size());
  for (const auto& [c, n] : count) {
    const Vec3 centre = voxel * (Vec3(std::get<0>(c), std::get<1>(c), std::get<2>(c)).array() + 0.5).matrix();
    const VoxelGrid::Voxel* found = grid.find(grid.key_of(centre.cast<float>()));
    RC_ASSERT(found && found->sums.points == static_cast<float>(std::min(n, 5)));
    RC_ASSERT((grid.centre_of(found->key) - centre).norm() < 1e-5);
  }
  for (const Vec3f& p : random_points(random, 100, 4)) {
    const Eigen::Vector3i c = ((p * static_cast<float>(1 / voxel)).array().floor()).cast<int>();
    RC_ASSERT((grid.find(grid.key_of(p)) != nullptr) == (count.count({c.x(), c.y(), c.z()}) > 0));
  }
}

TEST(VoxelGrid, ForgetsWhatIsFarAndTheFarthestBeyondItsLimit) {
  Random random(4);
  VoxelGrid grid(0.2, 100);
  const std::vector<Vec3f> points = random_points(random, 5000, 10);
  grid.insert(points);
  const Vec3 centre(1, 2, 3);
  const std::size_t all = grid.voxels().size();
  for (int i = 0; i < 10; ++i) grid.forget_some(centre, 6, all / 10 + 1);
  const std::size_t near = grid.voxels().size();
  for (const auto& v : grid.voxels()) {
    EXPECT_LE((grid.centre_of(v.key) - centre).cwiseAbs().maxCoeff(), 6);
    EXPECT_EQ(grid.find(v.key), &v);
  }
  for (const Vec3f& p : points) {
    const Vec3 d = (p.cast<double>() - centre).cwiseAbs();
    if (d.maxCoeff() < 5.8 || d.maxCoeff() > 6.2) {
      EXPECT_EQ(grid.find(grid.key_of(p)) != nullptr, d.maxCoeff() < 6) << p.transpose();
    }
  }
  grid.keep_nearest(centre, near / 2);
  EXPECT_LE(grid.voxels().size(), near / 2);
  EXPECT_GT(grid.voxels().size(), near / 3);
  double farthest = 0;
  for (const auto& v : grid.voxels())
    farthest = std::max(farthest, (grid.centre_of(v.key) - centre).cwiseAbs().maxCoeff());
  for (const Vec3f& p : points)
    if ((p.cast<double>() - centre).cwiseAbs().maxCoeff() < farthest - 0.2) {
      EXPECT_NE(grid.find(grid.key_of(p)), nullptr);
    }
}

TEST(VoxelGrid, MeansOfTwoGridsAgreeWhereverEachHasMorePoints) {
  // The same curved surface, sampled at densities that fall off in opposite directions.
  Random random(5);
  const auto surface = [&](bool dense_left, std::size_t count) {
    std::vector<Vec3f> points;
    while (points.size() < count) {
      const double x = random.uniform(-0.45, 0.45), y = random.uniform(-0.45, 0.45);
      if (random.uniform(-0.55, 0.55) > (dense_left ? -x : x)) continue;
      points.push_back(Vec3(x, y, 0.15 + 0.5 * x * x).cast<float>());
    }
    return points;
  };
  VoxelGrid a(0.3, 1'000'000), b(0.3, 1'000'000);
  a.insert(surface(true, 20000)), b.insert(surface(false, 4000));
  const auto key = a.key_of(Vec3f(0.15f, 0.15f, 0.15f));
  const MeanPair pair = means_of(a, key, a.window_around(key), b.window_around(key));
  const double plain = std::abs(Oracle(surface(true, 20000), Vec3f(0.15f, 0.15f, 0.15f), 0.3).mean.x() -
                                Oracle(surface(false, 4000), Vec3f(0.15f, 0.15f, 0.15f), 0.3).mean.x());
  EXPECT_LT(std::abs(pair.a.x() - pair.b.x()), plain / 3);
  EXPECT_LT(std::abs(pair.a.z() - pair.b.z()), 0.004);
}

}  // namespace
