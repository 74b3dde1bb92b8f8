#include "sdk/survey_export/wall_mesh.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "tests/unit/replay/folder.h"
#include "tests/unit/survey_export/carved_map.h"

namespace karst::survey_export {
namespace {

using core::Vec3;

/// Of a closed surface wound counter-clockwise as seen from outside; negative if seen from inside.
double signed_volume_m3(const cave::TriangleMesh& mesh) {
  double six = 0;
  for (const auto& t : mesh.triangles)
    six += mesh.vertices[t[0]].cast<double>().dot(
        mesh.vertices[t[1]].cast<double>().cross(mesh.vertices[t[2]].cast<double>()));
  return six / 6;
}

TEST(WallMesh, OfARoomIsClosedAndFacesIntoIt) {
  const core::VoxelMap map = test::tunnel_map();
  const WallMesh walls = wall_mesh(map);
  EXPECT_EQ(walls.open_edges, 0u);
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& t : walls.mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) edges.insert(std::minmax(t[i], t[(i + 1) % 3]));
  EXPECT_EQ(static_cast<long>(walls.mesh.vertices.size()) - static_cast<long>(edges.size()) +
                static_cast<long>(walls.mesh.triangles.size()),
            2);  // Euler's number of a ball
  EXPECT_NEAR(signed_volume_m3(walls.mesh), -30.0 * 4 * 3, 0.03 * 360);
  ASSERT_EQ(walls.normals.size(), walls.mesh.vertices.size());
  const Vec3 middle(15, 0, 1.5);
  for (std::size_t i = 0; i < walls.normals.size(); ++i) {
    EXPECT_NEAR(walls.normals[i].norm(), 1, 1e-4);
    EXPECT_GT(walls.normals[i].dot((middle - walls.mesh.vertices[i].cast<double>()).cast<float>()), 0);
  }
}

TEST(WallMesh, IsOpenWhereNothingWasSeen) {
  const core::VoxelMap map = test::tunnel_map(test::box({22, -10, -10}, {50, 10, 10}));
  const WallMesh walls = wall_mesh(map);
  EXPECT_GT(walls.open_edges, 0u);
  for (const core::Vec3f& v : walls.mesh.vertices) EXPECT_LE(v.x(), 22.001f);
}

TEST(WallMesh, IsReadAgain) {
  const test::Folder folder;
  const WallMesh walls = wall_mesh(test::tunnel_map());
  const std::string ply = folder.write("walls.ply", ply_bytes(walls)),
                    stl = (folder.path() / "walls.stl").string();
  cave::write_mesh(stl, walls.mesh);
  cave::check_declared_size(ply);
  EXPECT_EQ(cave::load_mesh(ply).triangles.size(), walls.mesh.triangles.size());
  EXPECT_EQ(cave::load_mesh(ply).vertices.size(), walls.mesh.vertices.size());
  EXPECT_EQ(cave::load_mesh(stl).triangles.size(), walls.mesh.triangles.size());
}

TEST(WallMesh, OfAMapWithoutRockIsEmpty) {
  const WallMesh walls = wall_mesh(core::VoxelMap(core::MapOptions{}));
  EXPECT_TRUE(walls.mesh.triangles.empty());
  EXPECT_NE(ply_bytes(walls).find("element face 0\n"), std::string::npos);
}

}  // namespace
}  // namespace karst::survey_export
