// Points of surfaces with a closed form become caves again; what was left out of them is reported.
#include "sdk/cave_from_cloud/cave_from_cloud.h"

#include <gtest/gtest.h>

#include <map>

#include "plugins/simulator/cave/mesh_volume.h"
#include "plugins/simulator/cave/preflight.h"
#include "plugins/simulator/cave_generator/generate_cave.h"
#include "tests/unit/cave_from_cloud/las_writer.h"
#include "tests/unit/cave_from_cloud/scans.h"

namespace karst::from_cloud {
namespace {

using cave::MeshFrame;
using cave::TriangleMesh;
using core::Vec3;
using core::Vec3f;
using test::error_of;
using test::scan_of_hall_and_passage;

class CaveFromCloudTest : public testing::Test {
 protected:
  CaveFromCloudTest() { options_.resolution_m = 0.15; }
  ~CaveFromCloudTest() override { std::filesystem::remove_all(folder_); }

  std::string scan(const std::vector<Vec3>& points, const std::vector<Vec3>& normals = {}) const {
    test::write_scan(folder_ + "/scan.ply", points, normals);
    return folder_ + "/scan.ply";
  }
  CaveFromCloud made(const std::string& file, const MeshFrame& frame = {}) const {
    return cave_from_cloud(file, frame, options_);
  }

  CloudOptions options_;
  const std::string folder_ = test::scratch_folder();
};

/// Whether every edge is run along once each way.
bool is_closed(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> runs;
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) ++runs[{t[i], t[(i + 1) % 3]}];
  for (const auto& [edge, n] : runs)
    if (n != 1 || !runs.contains({edge.second, edge.first})) return false;
  return true;
}

template <class ToWall>
double mean_error_m(const TriangleMesh& mesh, const ToWall& to_wall) {
  double sum = 0;
  for (const Vec3f& v : mesh.vertices) sum += std::abs(to_wall(v.cast<double>()));
  return sum / static_cast<double>(mesh.vertices.size());
}

TEST_F(CaveFromCloudTest, AClosedCaveComesOutClosedInPlaceAndOfTheSameVolume) {
  const std::string file = scan(scan_of_hall_and_passage({}));
  const CaveFromCloud c = made(file);
  EXPECT_TRUE(is_closed(c.mesh));
  const double truth = test::hall_and_passage_m3(true);
  EXPECT_NEAR(cave::enclosed_volume_m3(c.mesh), truth, 0.02 * truth)
      << "positive: the triangles face the air";
  EXPECT_NEAR(c.report.volume_m3, truth, 0.02 * truth);
  EXPECT_LT(mean_error_m(c.mesh, test::to_wall), 0.1 * options_.resolution_m);
  EXPECT_LT(c.report.guessed.area_m2, 0.01 * c.report.guessed.whole_m2);
  EXPECT_EQ(c.report.off_surface, 0u);
  EXPECT_EQ(c.report.lonely, 0u);
  EXPECT_EQ(c.report.normals, NormalsFrom::points);
  EXPECT_TRUE(c.report.findings.empty()) << c.report.findings.front();
  ASSERT_TRUE(c.start.has_value());
  EXPECT_LT(test::to_wall(c.start->position), -0.7);
  const cave::Cave cave = test::make_cave(c.mesh, c.start->position);
  EXPECT_EQ(error_of([&] { cave::check_start(cave, 0.3); }), "");

  const CaveFromCloud again = made(file);
  EXPECT_EQ(again.mesh.vertices, c.mesh.vertices) << "to the bit";
  EXPECT_EQ(again.mesh.triangles, c.mesh.triangles);
}

TEST_F(CaveFromCloudTest, AnEntranceAndAHoleAreClosedAndReportedAtTheirPlaces) {
  const CaveFromCloud c = made(scan(scan_of_hall_and_passage({.entrance = true, .roof_hole_m = 0.7})));
  EXPECT_TRUE(is_closed(c.mesh));
  const double truth = test::hall_and_passage_m3(false);
  EXPECT_NEAR(c.report.volume_m3, truth, 0.03 * truth);
  ASSERT_GE(c.report.guessed.patches.size(), 2u);
  const GuessedPatch &entrance = c.report.guessed.patches[0], &hole = c.report.guessed.patches[1];
  EXPECT_LT((entrance.centre - Vec3(test::kLength_m, 0, 0)).norm(), 1);
  EXPECT_NEAR(entrance.diameter_m, 2 * (test::kPassage_m - c.report.guessed_beyond_m), 0.8);
  EXPECT_LT((hole.centre - Vec3(0, 0, test::kHall_m)).norm(), 0.15);
  EXPECT_NEAR(hole.diameter_m, 2 * (0.7 - c.report.guessed_beyond_m), 0.3);
  EXPECT_GT(c.report.guessed.area_m2, 1.5);
  EXPECT_LT(c.report.guessed.area_m2, 8);
}

// A ball of 0.8 m radius without a disc 20 cm across.
TEST_F(CaveFromCloudTest, AHoleOfTwentyCentimetresIsReportedAtItsPlace) {
  core::Random random(8);
  const Vec3 missing = 0.8 * Vec3(1, 2, 2).normalized();
  std::vector<Vec3> points;
  while (points.size() < 60000)
    if (const Vec3 p = 0.8 * test::random_unit(random); (p - missing).norm() > 0.1) points.push_back(p);
  options_.resolution_m = 0.04;
  options_.guessed_beyond_m = 0.04;
  const CaveFromCloud c = made(scan(points));
  ASSERT_EQ(c.report.guessed.patches.size(), 1u);
  EXPECT_LT((c.report.guessed.patches[0].centre - missing).norm(), 0.03);
  EXPECT_GT(c.report.guessed.area_m2, 0.001);
  EXPECT_LT(c.report.guessed.area_m2, 0.0314) << "of the hole itself";
}

TEST_F(CaveFromCloudTest, AGeneratedCaveIsFoundAgainInPointsOfItsMesh) {
  cave::CaveRecipe recipe = cave::cave_preset("small");
  recipe.volume_m3 = 500;
  recipe.grid_m = 0.4;
  const cave::GeneratedCave real = cave::generate_cave(recipe, 4);
  core::Random random(1);
  std::vector<Vec3> points;
  double due = 0;  // of 25 points a square metre
  for (const auto& t : real.mesh.triangles) {
    const Vec3 a = real.mesh.vertices[t[0]].cast<double>(), ab = real.mesh.vertices[t[1]].cast<double>() - a,
               ac = real.mesh.vertices[t[2]].cast<double>() - a;
    for (due += 25 * ab.cross(ac).norm() / 2; due > 1; due -= 1) {
      const double u = std::sqrt(random.uniform()), v = random.uniform();
      points.push_back(a + u * (1 - v) * ab + u * v * ac);
    }
  }
  options_.resolution_m = 0.3;
  options_.start = real.start;
  const CaveFromCloud c = made(scan(points));
  EXPECT_TRUE(is_closed(c.mesh));
  EXPECT_NEAR(c.report.volume_m3, real.volume_m3, 0.02 * real.volume_m3);
  const cave::RayScene scene(real.mesh);
  EXPECT_LT(mean_error_m(c.mesh, [&](const Vec3& p) { return scene.distance_to_rock(p, 5); }),
            0.25 * options_.resolution_m);
  EXPECT_LT(c.report.off_surface, (c.report.thinned - c.report.lonely) / 50);
}

// Whether they point into the air or into the rock: what counts is that they agree.
TEST_F(CaveFromCloudTest, NormalsOfTheFileAreUsedOfEitherSign) {
  const std::vector<Vec3> points = scan_of_hall_and_passage({.spacing_m = 0.08});
  for (const double sign : {1.0, -1.0}) {
    std::vector<Vec3> normals;
    for (const Vec3& p : points) {
      Vec3 slope;
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 step = 1e-4 * Vec3::Unit(axis);
        slope[axis] = test::to_wall(p + step) - test::to_wall(p - step);
      }
      normals.push_back(sign * slope.normalized());
    }
    const CaveFromCloud c = made(scan(points, normals));
    EXPECT_EQ(c.report.normals, NormalsFrom::file);
    EXPECT_FALSE(c.report.orientation.has_value());
    EXPECT_GT(c.report.agreement, 0.99);
    const double truth = test::hall_and_passage_m3(true);
    EXPECT_NEAR(cave::enclosed_volume_m3(c.mesh), truth, 0.02 * truth);
  }
}

TEST_F(CaveFromCloudTest, PlacesOfTheScannerAreInTheCloudsOwnCoordinates) {
  MeshFrame frame;
  frame.metres_per_unit = 0.01;
  frame.offset = Vec3(67200000, 520000000, 0);
  std::vector<Vec3> points = scan_of_hall_and_passage({.spacing_m = 0.08});
  for (Vec3& p : points) p = frame.offset + 100 * p;
  options_.views = {frame.offset, frame.offset + Vec3(900, 0, 0)};
  const std::string file = scan(points);
  const CaveFromCloud c = made(file, frame);
  ASSERT_TRUE(c.report.orientation.has_value());
  EXPECT_GT(c.report.orientation->seen, c.report.thinned * 3 / 4);
  EXPECT_LT(mean_error_m(c.mesh, test::to_wall), 0.1 * options_.resolution_m);
  options_.views = {Vec3(0, 0, 0)};
  EXPECT_NE(error_of([&] { made(file, frame); }).find("in the cloud's own coordinates"), std::string::npos);
}

TEST_F(CaveFromCloudTest, OfSeveralCavesThatWithTheStartIsMadeOrTheLargest) {
  std::vector<Vec3> points = scan_of_hall_and_passage({.spacing_m = 0.08});
  const Vec3 ball(0, 20, 0);
  core::Random random(3);
  for (int i = 0; i < 9000; ++i) points.push_back(ball + 2 * test::random_unit(random));
  const std::string file = scan(points);
  const double large = test::hall_and_passage_m3(true), small = 4.0 / 3 * std::numbers::pi * 8;
  const CaveFromCloud largest = made(file);
  EXPECT_NEAR(largest.report.volume_m3, large, 0.03 * large);
  EXPECT_GE(largest.report.other_parts, 1u);
  EXPECT_GT(largest.report.off_surface, 1000u) << "the ball's points";
  EXPECT_FALSE(largest.report.findings.empty());
  options_.start = cave::StartPose{ball, 0};
  EXPECT_NEAR(made(file).report.volume_m3, small, 0.03 * small);
  options_.start = cave::StartPose{Vec3(0, 9, 0), 0};
  EXPECT_NE(error_of([&] { made(file); }).find("start: no part of the surface encloses it"),
            std::string::npos);
}

TEST_F(CaveFromCloudTest, StrayPointsAreLeftOutAndCounted) {
  std::vector<Vec3> points = scan_of_hall_and_passage({.spacing_m = 0.08});
  core::Random random(2);
  for (int i = 0; i < 40; ++i) points.emplace_back(random.uniform(-40, 40), 30 + i, random.uniform(-40, 40));
  const CaveFromCloud c = made(scan(points));
  EXPECT_EQ(c.report.lonely, 40u);
  const double truth = test::hall_and_passage_m3(true);
  EXPECT_NEAR(c.report.volume_m3, truth, 0.03 * truth);
}

TEST_F(CaveFromCloudTest, TheResolutionFollowsFromTheSpacing) {
  options_.resolution_m = 0;
  const CaveFromCloud c = made(scan(scan_of_hall_and_passage({.spacing_m = 0.16})));
  EXPECT_NEAR(c.report.spacing_m, 0.17, 0.05);
  EXPECT_NEAR(c.report.resolution_m, 2 * c.report.spacing_m, 0.011);
  EXPECT_EQ(c.report.guessed_beyond_m, 2 * c.report.resolution_m);
}

TEST_F(CaveFromCloudTest, CloudsThatMakeNoCaveAreRefused) {
  std::vector<Vec3> points = scan_of_hall_and_passage({.spacing_m = 0.3});
  const auto refusal = [&](const std::vector<Vec3>& of) { return error_of([&] { made(scan(of)); }); };
  EXPECT_NE(refusal({points.begin(), points.begin() + 50}).find("too few for a surface"), std::string::npos);
  EXPECT_NE(refusal({Vec3(1, 2, 3)}).find("too few for a surface"), std::string::npos);
  options_.resolution_m = 0.02;
  points.clear();
  for (int i = 0; i < 8000; ++i) points.emplace_back(0.015 * i, 0, 0);
  EXPECT_NE(refusal(points).find("too long for a resolution of 0.02 m; --resolution 0.04"),
            std::string::npos);
  points.emplace_back(30000, 0, 0);
  EXPECT_NE(refusal(points).find("too far for a resolution"), std::string::npos);
}

TEST_F(CaveFromCloudTest, ALasFileInUtmCoordinatesBecomesACaveNearItsOffset) {
  test::LasFile las;
  las.minor = 4;
  las.format = 6;
  las.offset = {672000, 5200000, 400};
  for (const Vec3& p : scan_of_hall_and_passage({.spacing_m = 0.08})) {
    const Eigen::Vector3i stored = (1000 * p).array().round().matrix().cast<int>();
    las.points.push_back({{stored.x(), stored.y(), stored.z()}});
  }
  test::write_bytes(folder_ + "/utm.las", las.bytes());
  MeshFrame frame;
  frame.offset = Vec3(672000, 5200000, 400);
  const CaveFromCloud c = made(folder_ + "/utm.las", frame);
  EXPECT_LT(mean_error_m(c.mesh, test::to_wall), 0.1 * options_.resolution_m);
}

// Around a long thin passage, PCL adds a shell metres away: it encloses the passage and is far larger.
TEST_F(CaveFromCloudTest, TheShellAroundAThinCaveIsNoPartOfIt) {
  core::Random random(6);
  std::vector<Vec3> points;
  const double length_m = 60, radius_m = 0.3;
  for (int i = 0; i < 40000; ++i) {
    const double a = random.uniform(0, 2 * std::numbers::pi);
    points.emplace_back(random.uniform(0, length_m), radius_m * std::cos(a), radius_m * std::sin(a));
  }
  options_.resolution_m = 0.12;
  const CaveFromCloud c = made(scan(points));
  EXPECT_GE(c.report.other_parts, 1u) << "there is no shell: nothing is tested";
  const double truth = std::numbers::pi * radius_m * radius_m * length_m;
  EXPECT_NEAR(c.report.volume_m3, truth, 0.05 * truth);
}

}  // namespace
}  // namespace karst::from_cloud
