#include "plugins/simulator/cave/preflight.h"

#include "tests/unit/simulator/meshes.h"

namespace karst::test {
namespace {

std::string refusal(cave::TriangleMesh mesh, const Vec3& start) {
  const cave::Cave c = make_cave(std::move(mesh), start);
  return error_of([&] { cave::check_start(c, 0.3); });
}

TEST(Preflight, AStartInsideAClosedTunnelPasses) {
  EXPECT_EQ(refusal(tunnel_mesh(20, 3, 1), {10, 0, 0}), "");
}

TEST(Preflight, AStartTooNearToRockIsRefused) {
  EXPECT_NE(refusal(box_mesh({-5, -5, 0}, {5, 5, 4}), {0, 0, 0.2}).find("0.20 m from rock"),
            std::string::npos);
}

TEST(Preflight, AStartOutsideIsRefused) {
  const std::string e = refusal(box_mesh({-5, -5, 0}, {5, 5, 4}), {-0.001, 0, 6});
  EXPECT_NE(e.find("(0.00 0.00 6.00) is outside of the cave (0 % of its rays pass an odd number of surfaces"),
            std::string::npos)
      << e;
}

TEST(Preflight, AStartInsideABoulderIsRefused) {
  auto mesh = box_mesh({-9, -9, 0}, {9, 9, 9});
  append(mesh, box_mesh({-1, -1, 1}, {1, 1, 3}));
  EXPECT_NE(refusal(mesh, {0, 0, 2}).find("inside rock"), std::string::npos);
  EXPECT_EQ(refusal(mesh, {4, 4, 2}), "") << "beside the boulder is a good place";
}

TEST(Preflight, WindingOfTheTrianglesDoesNotMatter) {
  auto mesh = tunnel_mesh(20, 3, 2);
  core::Random r(1);
  for (auto& t : mesh.triangles)
    if (r.bits() & 1) std::swap(t[0], t[1]);
  EXPECT_EQ(refusal(mesh, {10, 0, 0}), "");
}

TEST(Preflight, AHoleAtTheStartIsReportedWithDirectionAndShare) {
  // Without the wall at +x: seen from the centre of a cube, a sixth of all directions.
  const cave::RayScene scene(box_mesh({-2, -2, -2}, {2, 2, 2}, 0b111101));
  const cave::Surroundings s = cave::look_around(scene, Vec3::Zero());
  EXPECT_NEAR(s.escape_fraction, 1.0 / 6, 0.002);
  EXPECT_LT((s.escape_direction - Vec3::UnitX()).norm(), 0.02);
  const std::string e = refusal(box_mesh({-2, -2, -2}, {2, 2, 2}, 0b111101), Vec3::Zero());
  EXPECT_NE(e.find("hole"), std::string::npos) << e;
  EXPECT_NE(e.find("(1.00 "), std::string::npos) << e;
  EXPECT_NE(e.find("loop of 4, 5.7 m across, 16 m², around 2.0 "), std::string::npos) << e;
  EXPECT_NE(e.find("--cap"), std::string::npos) << e;
}

TEST(Preflight, ASingleMissingTriangleIsFound) {
  auto mesh = tunnel_mesh(20, 3, 3);
  mesh.triangles.erase(mesh.triangles.begin() + 20 * 24);  // beside the middle
  EXPECT_NE(refusal(mesh, {10, 0, 0}).find("hole"), std::string::npos);
}

std::string climb_refusal(cave::TriangleMesh mesh, const Vec3& standing, double climb_m) {
  const cave::Cave c = make_cave(std::move(mesh), standing);
  return error_of([&] { cave::check_climb(c, standing, climb_m, 0.3); });
}

TEST(Preflight, ALowCeilingOverTheLaunchSiteIsRefusedWithTheHeightThatIsLeft) {
  // Standing with its centre at 0.3 m, its hull has 2.4 m up to the ceiling.
  const auto hall = box_mesh({-5, -5, 0}, {5, 5, 3});
  EXPECT_EQ(climb_refusal(hall, {0, 0, 0.3}, 2.29), "");
  const std::string e = climb_refusal(hall, {0, 0, 0.3}, 2.31);
  EXPECT_NE(e.find("start: from the floor"), std::string::npos) << e;
  EXPECT_NE(e.find("can rise by 2.3"), std::string::npos) << e;
  EXPECT_NE(e.find("rock is in the way at (0.00 0.00 3.00)"), std::string::npos) << e;
}

// Reasons were cut after 239 characters.
TEST(Preflight, AReasonIsSaidToItsEndHoweverLongItsNumbers) {
  const std::string e = climb_refusal(box_mesh({-5, -5, 0}, {5, 5, 3}), {0, 0, 0.3}, 1e200);
  EXPECT_GT(e.size(), 300u) << e;
  EXPECT_TRUE(e.ends_with("start elsewhere or hover lower")) << e;
}

TEST(Preflight, ABlockThatReachesIntoTheClimbIsRefusedAndOneBesideItIsNot) {
  for (const double reach : {0.28, 0.32}) {
    auto mesh = box_mesh({-5, -5, 0}, {5, 5, 5});
    append(mesh, box_mesh({reach, -1, 1.5}, {2, 1, 2}));
    EXPECT_EQ(climb_refusal(mesh, {0, 0, 0.3}, 1.5) == "", reach > 0.3) << reach;
  }
}

TEST(Preflight, ALoweredSphereRestsOnTheFloorOrNowhere) {
  const cave::RayScene hall(box_mesh({-5, -5, 0}, {5, 5, 9}));
  const auto rest = cave::lowered_sphere(hall, {1, 2, 2}, 0.3);
  ASSERT_TRUE(rest);
  EXPECT_LT((rest->centre - Vec3(1, 2, 0.3)).norm(), 2e-4);
  EXPECT_LT((rest->rock.point - Vec3(1, 2, 0)).norm(), 1e-9);
  EXPECT_FALSE(cave::lowered_sphere(hall, {1, 2, 4}, 0.3)) << "more than 3 m up";
}

TEST(Preflight, StandingOnASlopeOrBesideAWallIsNotInTheWayOfTheClimb) {
  auto mesh = box_mesh({-9, -9, -20}, {9, 9, 20});
  const double rise = std::tan(45 * std::numbers::pi / 180);
  add_quad(mesh, {-8, -8, -8 * rise}, {8, -8, 8 * rise}, {8, 8, 8 * rise}, {-8, 8, -8 * rise});
  EXPECT_EQ(climb_refusal(mesh, {0, 0, 0.3 * std::sqrt(2.0)}, 3), "");
  EXPECT_EQ(climb_refusal(box_mesh({-0.3, -5, 0}, {5, 5, 9}), {0, 0, 0.3}, 3), "");
}

class PreflightCaves : public testing::TestWithParam<std::pair<const char*, const char*>> {};
TEST_P(PreflightCaves, StartPoseFromTheDatasPagePasses) {
  SKIP_WITHOUT_CAVES();
  const cave::Cave c = cave::load_cave(caves_folder() + GetParam().first, GetParam().second);
  EXPECT_EQ(error_of([&] { cave::check_start(c, 0.3); }), "");
}
INSTANTIATE_TEST_SUITE_P(Develop, PreflightCaves,
                         testing::Values(std::pair{"indian_tunnel.stl", "-2.2 87.5 -5.8"},
                                         std::pair{"rough_tunnel.stl", "11.1 -0.5 2.1"},
                                         std::pair{"darpa_cave_01.ply", "14.0 0.1 1.3"},
                                         std::pair{"darpa_cave_02.ply", "16.0 -0.1 1.4"},
                                         std::pair{"jean_bernard.ply", "97.5 51.8 108.8"}));

}  // namespace
}  // namespace karst::test
