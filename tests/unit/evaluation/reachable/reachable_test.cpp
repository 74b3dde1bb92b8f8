#include "sdk/evaluation/reachable/reachable.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core_stack/common/error.h"
#include "plugins/simulator/cave/closest_point.h"
#include "sdk/evaluation/reachable/sight.h"
#include "sdk/evaluation/reachable/triangle_cells.h"
#include "tests/unit/evaluation/reachable/boxes.h"

namespace {

using karst::cave::TriangleMesh;
using karst::core::InputError;
using karst::core::Vec3;
using namespace karst::evaluation;
using karst::test::fill;
using karst::test::lattice_mesh;
using Lattice = std::set<std::array<int, 3>>;

constexpr std::array<CellKey, 6> kSteps{
    {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};

std::set<CellKey> connected(const std::set<CellKey>& cells, const CellKey& seed) {
  if (!cells.count(seed)) return {};
  std::set<CellKey> out{seed};
  std::vector<CellKey> queue{seed};
  while (!queue.empty()) {
    const CellKey k = queue.back();
    queue.pop_back();
    for (const CellKey& s : kSteps)
      if (cells.count(k + s) && out.insert(k + s).second) queue.push_back(k + s);
  }
  return out;
}

struct Oracle {
  std::set<CellKey> free, flyable, reachable;
};

/// The definition, cell by cell, with distances to every triangle and sights walked point by point. The start
/// must be flyable.
Oracle by_definition(const TriangleMesh& mesh, const Vec3& start, const ReachableOptions& o) {
  const double edge = o.resolution_m;
  std::vector<Triangle> triangles;
  Vec3 low = Vec3::Constant(1e9), high = -low;
  for (const auto& t : mesh.triangles)
    triangles.push_back({mesh.vertices[t[0]].cast<double>(), mesh.vertices[t[1]].cast<double>(),
                         mesh.vertices[t[2]].cast<double>()});
  for (const auto& v : mesh.vertices)
    low = low.cwiseMin(v.cast<double>()), high = high.cwiseMax(v.cast<double>());
  std::set<CellKey> open, clear;
  const auto key = [&](double v) { return static_cast<int>(std::floor(v / edge)); };
  for (CellKey k{0, 0, key(low.z())}; k.z <= key(high.z()); ++k.z)
    for (k.y = key(low.y()); k.y <= key(high.y()); ++k.y)
      for (k.x = key(low.x()); k.x <= key(high.x()); ++k.x) {
        const Vec3 p = edge * Vec3(k.x + 0.5, k.y + 0.5, k.z + 0.5);
        double distance = 1e9;
        bool rock = false;
        for (const Triangle& t : triangles) {
          distance = std::min(distance, (karst::cave::closest_on_triangle(p, t.a, t.b, t.c) - p).norm());
          rock = rock || overlaps_box(t, p, Vec3::Constant(edge / 2));
        }
        if (rock) continue;
        open.insert(k);
        if (distance >= o.clearance_m) clear.insert(k);
      }
  const CellKey seed{key(start.x()), key(start.y()), key(start.z())};
  Oracle out;
  out.free = connected(open, seed);
  std::set<CellKey> clear_free;
  for (const CellKey& k : clear)
    if (out.free.count(k)) clear_free.insert(k);
  out.flyable = connected(clear_free, seed);
  out.reachable = out.flyable;
  for (const CellKey& k : out.free) {
    if (out.flyable.count(k)) continue;
    for (const Vec3& d : sight_directions()) {
      bool seen = false;
      CellKey last = k;
      for (double s = 0; s <= o.sight_m / edge; s += 0.01) {
        const Vec3 p = Vec3(k.x + 0.5, k.y + 0.5, k.z + 0.5) + s * d;
        const CellKey at{static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y())),
                         static_cast<int>(std::floor(p.z()))};
        if (at == last) continue;
        last = at;
        seen = out.flyable.count(at) > 0;
        if (seen || !out.free.count(at)) break;
      }
      if (seen) {
        out.reachable.insert(k);
        break;
      }
    }
  }
  return out;
}

std::set<CellKey> keys(const CellSet& s) {
  std::set<CellKey> out;
  s.for_each([&](const CellKey& k) { out.insert(k); });
  return out;
}

/// Sights along cell diagonals pass corners and edges, where a walk in steps cuts them: those cells may
/// differ.
void expect_same(const Reachable& r, const Oracle& oracle, std::size_t allowed_sight_differences) {
  EXPECT_EQ(keys(r.free), oracle.free);
  EXPECT_EQ(keys(r.flyable), oracle.flyable);
  std::size_t different = 0;
  for (const CellKey& k : oracle.free) different += r.contains(k) != (oracle.reachable.count(k) > 0);
  EXPECT_LE(different, allowed_sight_differences);
  EXPECT_EQ(r.free_cells, oracle.free.size());
  EXPECT_EQ(r.flyable_cells, oracle.flyable.size());
}

const Vec3 kOffset(0.03, -0.07, 0.05);  // off the grid, so that no wall lies on a cell's border

TEST(Reachable, BoxByDefinition) {
  Lattice cells;
  fill(cells, {0, 0, 0}, {3, 4, 3});
  const TriangleMesh mesh = lattice_mesh(cells, 1.0, kOffset);
  const ReachableOptions o;
  const Vec3 start(1.5, 2, 1.5);
  const Reachable r = find_reachable(mesh, start, o, "box");
  expect_same(r, by_definition(mesh, start, o), 0);
  // 3 x 4 x 3 m with a layer of rock cells: closed form.
  EXPECT_EQ(r.reachable_cells, 14u * 19 * 14);
  EXPECT_NEAR(r.volume_m3(), 14 * 19 * 14 * 0.008, 1e-9);
}

TEST(Reachable, BentTunnelByDefinition) {
  Lattice cells;
  fill(cells, {0, 0, 0}, {7, 2, 2});
  fill(cells, {5, 0, 0}, {7, 6, 2});
  const TriangleMesh mesh = lattice_mesh(cells, 1.0, kOffset);
  const ReachableOptions o;
  const Vec3 start(1, 1, 1);
  expect_same(find_reachable(mesh, start, o, "bent"), by_definition(mesh, start, o), 0);
}

TEST(Reachable, CrackTooNarrowToFlyIsSeenButWhatLiesRoundItsCornerIsNot) {
  // A room; a crack 0.6 m wide leads on from it, turns a corner, and opens into a second room.
  Lattice cells;
  fill(cells, {0, 0, 0}, {5, 5, 4});
  fill(cells, {5, 2, 1}, {8, 3, 2});
  fill(cells, {7, 2, 1}, {8, 7, 2});
  fill(cells, {6, 7, 0}, {9, 9, 4});
  const TriangleMesh mesh = lattice_mesh(cells, 0.6, kOffset);
  const ReachableOptions o;
  const Vec3 start(1.5, 1.5, 1.2);
  const Reachable r = find_reachable(mesh, start, o, "crack");
  const Oracle oracle = by_definition(mesh, start, o);
  expect_same(r, oracle, oracle.free.size() / 100);
  const auto at = [&](double x, double y, double z) {
    return CellKey{static_cast<int>(std::floor(x / 0.2)), static_cast<int>(std::floor(y / 0.2)),
                   static_cast<int>(std::floor(z / 0.2))};
  };
  EXPECT_TRUE(r.contains(at(3.7, 1.45, 0.95)));         // in the crack, in view of the room
  EXPECT_TRUE(r.free.contains(at(4.5, 4.8, 1.2)));      // the second room is connected
  EXPECT_FALSE(r.flyable.contains(at(4.5, 4.8, 1.2)));  // but there is no way to fly there
  EXPECT_FALSE(r.contains(at(4.5, 4.8, 1.2)));          // nor to see it
}

TEST(Reachable, OpenCaveNamesTheHole) {
  Lattice cells;
  fill(cells, {0, 0, 0}, {8, 3, 3});
  TriangleMesh mesh = lattice_mesh(cells, 1.0, kOffset);
  // Take the end wall's middle face away: x = 8, y 1..2, z 1..2. A tall tower behind keeps the bounds wide.
  std::erase_if(mesh.triangles, [&](const auto& t) {
    const auto center = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
    return center.x() > 8 && std::abs(center.y() - 1.5) < 0.5 && std::abs(center.z() - 1.5) < 0.5;
  });
  Lattice tower;
  fill(tower, {20, 0, 0}, {21, 1, 30});
  const TriangleMesh far = lattice_mesh(tower, 1.0, kOffset);
  for (const auto& t : far.triangles) {
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto v : t) mesh.vertices.push_back(far.vertices[v]);
    mesh.triangles.push_back({base, base + 1, base + 2});
  }
  try {
    find_reachable(mesh, {1.5, 1.5, 1.5}, {}, "open.ply");
    FAIL() << "no error";
  } catch (const InputError& e) {
    const std::string what = e.what();
    EXPECT_EQ(what.find("open.ply: start 1.5 1.5 1.5: free space leads outside the mesh near "), 0u) << what;
    double x = 0, y = 0, z = 0;
    ASSERT_EQ(std::sscanf(what.c_str() + what.find("near ") + 5, "%lf %lf %lf", &x, &y, &z), 3) << what;
    EXPECT_LT((Vec3(x, y, z) - Vec3(8, 1.5, 1.5)).norm(), 1.5) << what;
    EXPECT_NE(what.find("a loop of 4, 1.4 m across, 1 m², around 8.0 1.4 1."), std::string::npos) << what;
    EXPECT_NE(what.find("--cap OUT.ply"), std::string::npos) << what;
  }
}

/// A tunnel 3 km long and 4 m wide, and two boxes that make the bounds 3 x 2 x 2 km.
TriangleMesh long_tunnel() {
  Lattice cells{{0, 0, 0}, {749, 499, 499}};
  fill(cells, {0, 250, 250}, {750, 251, 251});
  return lattice_mesh(cells, 4.0, kOffset);
}

TEST(Reachable, ALongTunnelInWideBoundsTakesTheMemoryOfItsCells) {
  const Reachable r = find_reachable(long_tunnel(), {2, 1002, 1002}, {}, "long");
  EXPECT_EQ(r.free_cells, 14999u * 19 * 19);
  EXPECT_EQ(r.reachable_cells, r.free_cells);
  for (const CellSet* set : {&r.free, &r.flyable, &r.reachable}) {
    EXPECT_LE(set->block_count(), 4u * 4 * 1876);  // 19 cells lie in 3 or 4 blocks
    EXPECT_LE(set->tile_count(), 2u * 2 * 119);
  }
}

TEST(Reachable, AnOpenCaveInWideBoundsNamesTheHole) {
  TriangleMesh mesh = long_tunnel();
  std::erase_if(mesh.triangles, [&](const auto& t) {  // of the roof
    const auto center = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
    return center.z() > 1003.9f && center.z() < 1010 && center.x() > 400 && center.x() < 404;
  });
  try {
    find_reachable(mesh, {300, 1002, 1002}, {}, "long.ply");
    FAIL() << "no error";
  } catch (const InputError& e) {
    const std::string what = e.what();
    const std::size_t near = what.find("free space leads outside the mesh near ");
    ASSERT_NE(near, std::string::npos) << what;
    double x = 0, y = 0, z = 0;
    ASSERT_EQ(std::sscanf(what.c_str() + what.find("near ", near) + 5, "%lf %lf %lf", &x, &y, &z), 3) << what;
    EXPECT_LT((Vec3(x, y, z) - Vec3(402, 1002, 1004)).norm(), 5) << what;
  }
}

TEST(Reachable, WhatNoCaveMeasuresIsTooLarge) {
  Lattice cells;
  fill(cells, {0, 0, 0}, {4, 4, 4});
  const TriangleMesh mesh = lattice_mesh(cells, 1.0, kOffset);
  const auto message = [&](const karst::core::Vec3f& far) -> std::string {
    TriangleMesh stray = mesh;
    stray.vertices[0] = far;
    try {
      find_reachable(stray, {2, 2, 2}, {}, "stray.ply");
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  const std::string expected = "the mesh is too large for cells of 0.2 m";
  EXPECT_NE(message({2e5f, 0, 0}).find(expected), std::string::npos) << "200 km along an axis";
  EXPECT_NE(message({3e4f, 3e4f, 3e4f}).find(expected), std::string::npos) << "30 x 30 x 30 km";
  EXPECT_NE(message({8e3f, 8e3f, 4e3f}).find(expected), std::string::npos) << "one triangle 8 x 8 x 4 km";
}

/// The mesh as an OBJ file, its coordinates turned.
std::string written_obj(const std::string& name, const TriangleMesh& mesh, bool y_up) {
  const std::filesystem::path folder = std::filesystem::path(KARST_BINARY_DIR) / "test_runs";
  std::filesystem::create_directories(folder);
  std::ofstream out(folder / name);
  out.precision(9);
  for (const auto& v : mesh.vertices)
    if (y_up)
      out << "v " << v.x() << ' ' << v.z() << ' ' << -v.y() << '\n';
    else
      out << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
  for (const auto& t : mesh.triangles) out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  return (folder / name).string();
}

TEST(Reachable, ACaveWithYUpHasTheSameVolumes) {
  Lattice cells;
  fill(cells, {0, 0, 0}, {7, 2, 2});
  fill(cells, {5, 0, 0}, {7, 6, 3});
  const TriangleMesh mesh = lattice_mesh(cells, 1.0, kOffset);
  karst::cave::MeshFrame y_up;
  y_up.up = karst::core::UpAxis::y;
  const TriangleMesh a = karst::cave::load_mesh(written_obj("z_up.obj", mesh, false)),
                     b = karst::cave::load_mesh(written_obj("y_up.obj", mesh, true), y_up);
  const Vec3 start(1, 1, 1);
  const Reachable of_a = find_reachable(a, start, {}, "a"), of_b = find_reachable(b, start, {}, "b");
  EXPECT_GT(of_a.reachable_cells, 1000u);
  EXPECT_EQ(keys(of_a.reachable), keys(of_b.reachable));
  EXPECT_EQ(of_a.volume_m3(), of_b.volume_m3());
  EXPECT_EQ(of_a.flyable_cells, of_b.flyable_cells);
}

TEST(Reachable, BadStartsAreErrors) {
  Lattice cells;
  fill(cells, {0, 0, 0}, {4, 4, 1});
  const TriangleMesh mesh = lattice_mesh(cells, 1.0, kOffset);
  const auto message = [&](const Vec3& start) -> std::string {
    try {
      find_reachable(mesh, start, {}, "low.ply");
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(message({2, 2, 0.5}).find("no place with 0.6 m to rock"), std::string::npos);
  EXPECT_NE(message({2, 2, 0.05}).find("in rock"), std::string::npos);
  EXPECT_NE(message({2, 2, 90}).find("outside the mesh"), std::string::npos);
  EXPECT_THROW(find_reachable({}, {0, 0, 0}, {}, "none.ply"), InputError);
  TriangleMesh huge = mesh;
  huge.vertices[0].x() = 1e7f;
  EXPECT_THROW(find_reachable(huge, {2, 2, 0.5}, {}, "huge.ply"), InputError);
}

TEST(Reachable, StandingVehicleStartsFromTheAirAboveIt) {
  Lattice cells;
  fill(cells, {0, 0, 0}, {4, 4, 3});
  const TriangleMesh mesh = lattice_mesh(cells, 1.0, kOffset);
  const Reachable hovering = find_reachable(mesh, {2, 2, 1.5}, {}, "room");
  const Reachable standing = find_reachable(mesh, {2, 2, 0.35}, {}, "room");
  EXPECT_EQ(keys(standing.reachable), keys(hovering.reachable));
}

TEST(Reachable, RockOnTheBorderOfCellsHasNoHoles) {
  // As it was: a roof at z = 37 lay between two layers of cells, touched neither by rounding, and "led
  // outside".
  Lattice cells;
  fill(cells, {0, 0, 0}, {3, 3, 3});
  for (int k = 0; k < 250; ++k) {
    const double z = 0.2 * k;
    EXPECT_NO_THROW(find_reachable(lattice_mesh(cells, 1.0, Vec3(0, 0, z)), {1.5, 1.5, z + 1.5}, {}, "room"))
        << z;
  }
}

TEST(Reachable, RealCaveHasTheVolumesOfItsDescription) {
  const std::filesystem::path file =
      std::filesystem::path(KARST_SOURCE_DIR) / "../shared/data/caves/develop/indian_tunnel.stl";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "skipped: no ../shared";
  const TriangleMesh mesh = karst::cave::load_mesh(file.string());
  const Reachable r = find_reachable(mesh, {-2.2, 87.5, -5.8}, {}, "indian_tunnel");
  EXPECT_NEAR(r.free_volume_m3(), 8600, 0.03 * 8600);
  EXPECT_NEAR(r.flyable_volume_m3(), 6500, 0.03 * 6500);
  EXPECT_GE(r.reachable_cells, r.flyable_cells);
  EXPECT_LE(r.reachable_cells, r.free_cells);
}

TEST(Sight, PassesEveryCellOnceByFaces) {
  for (const Vec3& d : sight_directions()) {
    EXPECT_NEAR(d.norm(), 1, 1e-12);
    CellKey last;
    for (const CellKey& k : cells_along(d, 30)) {
      EXPECT_EQ(std::abs(k.x - last.x) + std::abs(k.y - last.y) + std::abs(k.z - last.z), 1);
      // The cell's cube, from -0.5 to 0.5 about its centre, is met by the ray: its centre is near it.
      const Vec3 p(k.x, k.y, k.z);
      EXPECT_LE((p - p.dot(d) * d).norm(), std::sqrt(3.0) / 2 + 1e-9);
      last = k;
    }
    EXPECT_NEAR(Vec3(last.x, last.y, last.z).norm(), 30, 1.0);
  }
}

}  // namespace
