#include "plugins/simulator/cave/propose_start.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <set>

#include "plugins/simulator/cave/air_columns.h"
#include "plugins/simulator/cave/preflight.h"
#include "plugins/simulator/cave/remedies.h"
#include "plugins/simulator/environment/launch_site.h"
#include "tests/unit/evaluation/reachable/boxes.h"
#include "tests/unit/simulator/meshes.h"

namespace karst::test {
namespace {

using cave::RayScene;
using cave::StartPose;
using cave::TriangleMesh;

/// What the launch check of the default vehicle and mission says, or "".
std::string launch_refusal(const TriangleMesh& mesh, const StartPose& start) {
  constexpr double kRadius_m = 0.3, kClimb_m = 0.7;
  cave::Cave c = make_cave(mesh, start.position, start.heading_rad);
  const std::string refused = error_of([&] { cave::check_start(c, kRadius_m); });
  if (!refused.empty()) return refused;
  const sim::LaunchSite site = sim::set_down(c, kRadius_m);
  if (site.pad) return "it stands on a pad and not on the floor";
  return error_of([&] { cave::check_climb(c, site.T_world_start.position, kClimb_m, kRadius_m); });
}

/// Level rooms and a corridor between them.
TriangleMesh rooms() {
  std::set<std::array<int, 3>> cells;
  fill(cells, {0, 0, 0}, {6, 6, 3});
  fill(cells, {6, 2, 0}, {20, 4, 2});
  fill(cells, {20, 0, 0}, {26, 8, 4});
  return lattice_mesh(cells, 1.0, {0.03, 0.04, 0.05});
}

TEST(AirColumns, OfABoxAreAsHighAsTheBox) {
  const auto columns = cave::air_columns(RayScene(box_mesh({-5, -4, 1}, {5, 4, 4})), 200);
  EXPECT_NEAR(static_cast<double>(columns.size()), 200, 1);
  double x = 0;
  for (const cave::AirColumn& c : columns) {
    EXPECT_NEAR(c.floor.z(), 1, 1e-5);
    EXPECT_NEAR(c.height_m, 3, 1e-5);
    x += c.floor.x() / static_cast<double>(columns.size());
  }
  EXPECT_NEAR(x, 0, 1) << "spread over the floor";
}

TEST(AirColumns, OverAndUnderABlockAreTwo) {
  auto mesh = box_mesh({0, 0, 0}, {10, 10, 8});
  append(mesh, box_mesh({1, 1, 3}, {9, 9, 4}));
  std::size_t under = 0, over = 0;
  for (const cave::AirColumn& c : cave::air_columns(RayScene(mesh), 300)) {
    under += std::abs(c.floor.z()) < 1e-5 && std::abs(c.height_m - 3) < 1e-5;
    over += std::abs(c.floor.z() - 4) < 1e-5 && std::abs(c.height_m - 4) < 1e-5;
  }
  EXPECT_GT(under, 100u);
  EXPECT_EQ(under, over);
}

TEST(AirColumns, ThroughAHoleAreLeftOut) {
  EXPECT_TRUE(cave::air_columns(RayScene(box_mesh({0, 0, 0}, {5, 5, 5}, 0b011111)), 100).empty());
}

TEST(ProposeStart, WhatIsProposedPassesTheLaunchCheck) {
  for (const TriangleMesh& mesh :
       {rooms(), box_mesh({0, 0, 0}, {4, 3, 2}), box_mesh({0, 0, -9}, {9, 9, 9})}) {
    const auto start = cave::propose_start(RayScene(mesh));
    ASSERT_TRUE(start);
    EXPECT_EQ(launch_refusal(mesh, *start), "") << cave::start_text(*start);
  }
}

TEST(ProposeStart, InRoughTunnelsWhatIsProposedPassesTheLaunchCheck) {
  int proposed = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const TriangleMesh mesh = tunnel_mesh(30, 3 + 0.25 * static_cast<double>(seed), seed);
    const auto start = cave::propose_start(RayScene(mesh));
    if (!start) continue;
    ++proposed;
    EXPECT_EQ(launch_refusal(mesh, *start), "") << seed << ": " << cave::start_text(*start);
  }
  EXPECT_GE(proposed, 6);
}

TEST(ProposeStart, IsTheSameEveryTimeAndAsItsTextHasIt) {
  const auto start = cave::propose_start(RayScene(rooms())), again = cave::propose_start(RayScene(rooms()));
  ASSERT_TRUE(start && again);
  EXPECT_EQ(cave::start_text(*start), cave::start_text(*again));
  double x = 0, y = 0, z = 0, heading_deg = 0;
  ASSERT_EQ(std::sscanf(cave::start_text(*start).c_str(), "%lf %lf %lf %lf", &x, &y, &z, &heading_deg), 4);
  EXPECT_EQ(start->position, Vec3(x, y, z)) << "rounded before it is checked";
  EXPECT_NEAR(start->heading_rad * 180 / std::numbers::pi, heading_deg, 1e-9);
}

TEST(ProposeStart, LooksAlongTheLongestSight) {
  const auto start = cave::propose_start(RayScene(box_mesh({0, -2, 0}, {40, 2, 3})));
  ASSERT_TRUE(start);
  const double along = std::cos(start->heading_rad);
  EXPECT_GT(start->position.x() < 20 ? along : -along, 0.95);
}

TEST(ProposeStart, NeedsAirRoomAndLevelFloor) {
  EXPECT_FALSE(cave::propose_start(RayScene(box_mesh({0, 0, 0}, {9, 9, 1.4})))) << "too low";
  EXPECT_FALSE(cave::propose_start(RayScene(box_mesh({0, 0, 0}, {9, 1.3, 9})))) << "too narrow";
  for (const double degrees : {20.0, 45.0}) {  // of the floor, which rises along x
    const double high = 9 * std::tan(degrees * std::numbers::pi / 180);
    TriangleMesh m;
    add_quad(m, {0, 0, 0}, {9, 0, high}, {9, 9, high}, {0, 9, 0});
    add_quad(m, {0, 0, 20}, {9, 0, 20}, {9, 9, 20}, {0, 9, 20});
    add_quad(m, {0, 0, 0}, {0, 9, 0}, {0, 9, 20}, {0, 0, 20});
    add_quad(m, {9, 0, high}, {9, 9, high}, {9, 9, 20}, {9, 0, 20});
    add_quad(m, {0, 0, 0}, {9, 0, high}, {9, 0, 20}, {0, 0, 20});
    add_quad(m, {0, 9, 0}, {9, 9, high}, {9, 9, 20}, {0, 9, 20});
    EXPECT_EQ(cave::propose_start(RayScene(m)).has_value(), degrees < 28) << degrees;
  }
}

TEST(ProposeStart, IsNotInsideABoulderNorOutside) {
  auto mesh = box_mesh({0, 0, 0}, {12, 12, 12});
  append(mesh, box_mesh({3, 3, 0.5}, {9, 9, 11}));  // roomier inside than the gap around
  const auto start = cave::propose_start(RayScene(mesh));
  ASSERT_TRUE(start);
  EXPECT_EQ(launch_refusal(mesh, *start), "");
  const Vec3& p = start->position;
  EXPECT_FALSE(p.x() > 3 && p.x() < 9 && p.y() > 3 && p.y() < 9 && p.z() > 0.5 && p.z() < 11)
      << p.transpose();
}

TEST(ProposeStart, OutOfSightOfAHoleIfItCan) {
  // Two rooms without a sight between them; the far wall of the second is missing.
  std::set<std::array<int, 3>> cells;
  fill(cells, {0, 0, 0}, {6, 6, 3});
  fill(cells, {5, 6, 0}, {6, 12, 2});
  fill(cells, {5, 11, 0}, {12, 12, 2});
  fill(cells, {12, 9, 0}, {18, 15, 4});
  TriangleMesh mesh = lattice_mesh(cells, 1.0, {0.03, 0.04, 0.05});
  std::erase_if(mesh.triangles, [&](const auto& t) {
    return mesh.vertices[t[0]].x() > 18 && mesh.vertices[t[1]].x() > 18 && mesh.vertices[t[2]].x() > 18;
  });
  const auto start = cave::propose_start(RayScene(mesh));
  ASSERT_TRUE(start);
  EXPECT_EQ(launch_refusal(mesh, *start), "");
  EXPECT_LT(start->position.y(), 8);
}

TEST(Remedies, AStartIsNamedUnlessTheGivenOneIsInTheAir) {
  const RayScene scene(rooms());
  const std::string none = cave::remedies(scene, {}, std::nullopt);
  EXPECT_EQ(none.find("; a start that suits: --start \""), 0u) << none;
  EXPECT_EQ(cave::remedies(scene, {}, Vec3(-5, 0, 0)), none);
  EXPECT_EQ(cave::remedies(scene, {}, Vec3(3, 3, 1)), "");
  const std::string mm = cave::remedies(RayScene(box_mesh({0, 0, 0}, {4e3, 4e3, 4e3})), {}, std::nullopt);
  EXPECT_NE(mm.find("(unit mm)"), std::string::npos) << mm;
  EXPECT_EQ(mm.find("--start"), std::string::npos) << "it would be a start in a wrong unit: " << mm;
}

}  // namespace
}  // namespace karst::test
