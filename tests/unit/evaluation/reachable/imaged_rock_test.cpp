#include "sdk/evaluation/reachable/imaged_rock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "plugins/simulator/truth_log.h"
#include "tests/unit/simulator/meshes.h"

namespace karst::evaluation {
namespace {

using core::Vec3;

PicturePose looking_east(const Vec3& from) {
  PicturePose p;
  p.T_world_camera.position = from;
  p.tan_half_width = 0.8, p.tan_half_height = 0.6;
  p.min_range_m = 0.3, p.max_range_m = 6, p.max_incidence_rad = 1.2;
  return p;
}

TEST(ImagedRock, OfAWallAheadIsThePicturesRectangle) {
  const cave::RayScene scene(test::box_mesh({-9, -9, -9}, {3.05, 9, 9}));
  const auto cells = imaged_rock(scene, std::vector{looking_east({0, 0, 0})}, 0.2);
  std::size_t within = 0, at_the_edge = 0;
  for (int y = -45; y < 45; ++y)
    for (int z = -45; z < 45; ++z) {
      const bool in = std::abs(0.2 * (y + 0.5)) < 3.05 * 0.8 && std::abs(0.2 * (z + 0.5)) < 3.05 * 0.6;
      const bool edge = std::abs(std::abs(0.2 * (y + 0.5)) - 3.05 * 0.8) < 0.2 ||
                        std::abs(std::abs(0.2 * (z + 0.5)) - 3.05 * 0.6) < 0.2;
      const bool found = std::binary_search(cells.begin(), cells.end(), CellKey{15, y, z});
      if (!edge) {
        EXPECT_EQ(found, in) << y << " " << z;
      }
      within += in && !edge;
      at_the_edge += edge && std::abs(0.2 * (y + 0.5)) < 3.05 * 0.8 + 0.2 &&
                     std::abs(0.2 * (z + 0.5)) < 3.05 * 0.6 + 0.2;
    }
  EXPECT_GE(cells.size(), within);
  EXPECT_LE(cells.size(), within + at_the_edge);
}

TEST(ImagedRock, FarOrSlantedRockDoesNotCount) {
  const cave::RayScene far(test::box_mesh({-20, -20, -20}, {6.5, 20, 20}));
  EXPECT_TRUE(imaged_rock(far, std::vector{looking_east({0, 0, 0})}, 0.2).empty());
  // Along a tunnel's floor, 1 m below: at 2.57 m the incidence is 1.2.
  const cave::RayScene floor(test::box_mesh({-30, -30, -1.05}, {30, 30, 30}));
  PicturePose p = looking_east({0, 0, 0});
  const auto cells = imaged_rock(floor, std::vector{p}, 0.2);
  ASSERT_FALSE(cells.empty());
  double furthest = 0;
  for (const CellKey& k : cells) furthest = std::max(furthest, 0.2 * k.x);
  EXPECT_NEAR(furthest, 1.05 * std::tan(1.2), 0.2);
  p.max_incidence_rad = 1.0;
  EXPECT_LT(imaged_rock(floor, std::vector{p}, 0.2).size(), cells.size());
}

TEST(ImagedRock, TheLogIsReadBackAndDamageIsTold) {
  const std::filesystem::path dir = test::scratch_folder();
  core::RgbCameraModel model;
  model.camera.horizontal_fov_rad = 1.4, model.camera.vertical_fov_rad = 1.0;
  const core::Pose T{{1, 2, 3}, core::Quat(Eigen::AngleAxisd(0.5, Vec3::UnitZ()))};
  {
    sim::TruthLog log(dir.string());
    log.picture(core::kSecond, T, model);
    log.picture(2 * core::kSecond, T, model);
    log.close();
  }
  std::vector<std::string> problems;
  const auto file = dir / "ground_truth_frames.csv";
  const auto poses = read_picture_poses(file, problems);
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_TRUE(problems.empty());
  EXPECT_EQ(poses[1].t_s, 2);
  EXPECT_NEAR((poses[0].T_world_camera.position - T.position).norm(), 0, 1e-6);
  EXPECT_NEAR(poses[0].T_world_camera.orientation.angularDistance(T.orientation), 0, 1e-6);
  EXPECT_NEAR(poses[0].tan_half_width, std::tan(0.7), 1e-6);
  std::ofstream(file, std::ios::app) << "3.000,nan,0,0,0,0,0,1,0.8,0.6,0.3,6,1.2\n";
  EXPECT_EQ(read_picture_poses(file, problems).size(), 2u);
  EXPECT_EQ(problems.size(), 1u);
  EXPECT_TRUE(read_picture_poses(dir / "none.csv", problems).empty());
  EXPECT_EQ(problems.size(), 1u) << "no camera is no problem";
}

}  // namespace
}  // namespace karst::evaluation
