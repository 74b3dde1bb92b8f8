#include "plugins/simulator/cave_generator/generate_cave.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>

#include "core_stack/common/error.h"
#include "plugins/simulator/cave/mesh_volume.h"
#include "plugins/simulator/cave_generator/plan.h"
#include "sdk/evaluation/reachable/reachable.h"

namespace {

using namespace karst::cave;
using karst::core::InputError;
using karst::core::Vec3;

/// Coarse and small, to be quick; with one of everything.
CaveRecipe quick_recipe() {
  CaveRecipe r = cave_preset("small");
  r.volume_m3 = 900;
  r.grid_m = 0.4;
  r.shafts = r.loops = 1;
  return r;
}

class GeneratedCaves : public testing::TestWithParam<std::uint64_t> {
 protected:
  GeneratedCave cave = generate_cave(quick_recipe(), GetParam());
};

TEST_P(GeneratedCaves, AreOneClosedManifoldThatFacesInwards) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> runs;
  for (const auto& t : cave.mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) ++runs[{t[i], t[(i + 1) % 3]}];
  for (const auto& [edge, n] : runs) {
    ASSERT_EQ(n, 1);
    ASSERT_EQ(runs.count({edge.second, edge.first}), 1u);
  }
  EXPECT_GT(enclosed_volume_m3(cave.mesh), 0);

  std::vector<std::uint32_t> parent(cave.mesh.vertices.size());
  for (std::uint32_t i = 0; i < parent.size(); ++i) parent[i] = i;
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const auto& t : cave.mesh.triangles) {
    parent[root(t[0])] = root(t[1]);
    parent[root(t[1])] = root(t[2]);
  }
  std::size_t surfaces = 0;
  for (std::uint32_t i = 0; i < parent.size(); ++i) surfaces += root(i) == i;
  EXPECT_EQ(surfaces, 1u);
}

TEST_P(GeneratedCaves, HaveTheVolumeAskedFor) {
  EXPECT_NEAR(cave.volume_m3, quick_recipe().volume_m3, kVolumeBand * quick_recipe().volume_m3);
}

TEST_P(GeneratedCaves, LeaveTheVehicleAWayAlongEveryPassage) {
  const RayScene scene(cave.mesh);
  ASSERT_FALSE(cave.axes.empty());
  const auto r = karst::evaluation::find_reachable(cave.mesh, cave.start.position, {}, "generated");
  for (const auto& axis : cave.axes)
    for (std::size_t i = 0; i + 1 < axis.size(); ++i)
      for (int k = 0; k < 10; ++k) {
        const Vec3 p = axis[i] + 0.1 * k * (axis[i + 1] - axis[i]);
        // Checked at steps of 0.3 m when it was made: half of that may be lost in between.
        EXPECT_GE(scene.distance_to_rock(p, 5), kPathClearanceM - 0.16);
        const Vec3 cell = (p / 0.2).array().floor();
        EXPECT_TRUE(r.free.contains(
            {static_cast<int>(cell.x()), static_cast<int>(cell.y()), static_cast<int>(cell.z())}));
      }
  EXPECT_GT(r.flyable_volume_m3(), 0.35 * r.free_volume_m3());
}

TEST_P(GeneratedCaves, StartOverLevelGround) {
  const RayScene scene(cave.mesh);
  const Vec3 p = cave.start.position;
  EXPECT_GE(scene.distance_to_rock(p, 5), 1.0);
  double lowest = 10, highest = 0;
  for (int i = 0; i < 12; ++i)
    for (const double r : {0.0, 0.6, 1.2}) {
      const double a = i * std::numbers::pi / 6;
      const double height = scene.ray_cast(p + r * Vec3(std::cos(a), std::sin(a), 0), -Vec3::UnitZ(), 10);
      lowest = std::min(lowest, height), highest = std::max(highest, height);
    }
  EXPECT_NEAR(lowest, 1.1, 0.25);
  EXPECT_LT(highest - lowest, 0.35);
}

INSTANTIATE_TEST_SUITE_P(Seeds, GeneratedCaves, testing::Values(2, 3));

TEST(GenerateCave, SameSeedSameBytesOtherSeedOtherCave) {
  CaveRecipe r = quick_recipe();
  r.volume_m3 = 500;
  const GeneratedCave a = generate_cave(r, 4), b = generate_cave(r, 4), c = generate_cave(r, 5);
  ASSERT_EQ(a.mesh.vertices.size(), b.mesh.vertices.size());
  EXPECT_EQ(std::memcmp(a.mesh.vertices.data(), b.mesh.vertices.data(),
                        a.mesh.vertices.size() * sizeof(karst::core::Vec3f)),
            0);
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
  EXPECT_NE(a.mesh.vertices.size(), c.mesh.vertices.size());
}

TEST(GenerateCave, VerticalityMakesItHigher) {
  CaveRecipe r = quick_recipe();
  r.shafts = r.chimneys = 0;
  const auto height = [](const CavePlan& plan) {
    double low = 0, high = 0;
    for (const Passage& p : plan.passages)
      for (const Station& s : p) low = std::min(low, s.center.z()), high = std::max(high, s.center.z());
    return high - low;
  };
  double level = 0, steep = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    r.verticality = 0;
    level += height(lay_out(r, seed, 150));
    r.verticality = 1;
    steep += height(lay_out(r, seed, 150));
  }
  EXPECT_GT(steep, 2 * level);
}

TEST(LayOut, MakesWhatWasAskedFor) {
  CaveRecipe r = cave_preset("medium");
  r.loops = r.shafts = r.chimneys = r.domes = 0;
  r.branching = 0;
  EXPECT_EQ(lay_out(r, 3, 200).passages.size(), 1u);
  EXPECT_EQ(lay_out(r, 3, 200).chambers.size(), 1u);
  r.branching = 0.6;
  const CavePlan branched = lay_out(r, 3, 200);
  EXPECT_GT(branched.passages.size(), 2u);
  double length_m = 0;
  for (const Passage& p : branched.passages) length_m += kStationStepM * static_cast<double>(p.size() - 1);
  EXPECT_NEAR(length_m, 200, 60);
  r.chimneys = 2;
  EXPECT_EQ(lay_out(r, 3, 200).passages.size(), branched.passages.size() + 2);
}

TEST(ScaleSections, MakesPassagesWiderAndLeavesTheirWay) {
  const CavePlan plain = lay_out(cave_preset("medium"), 3, 150);
  CavePlan wide = plain;
  scale_sections(wide, 1.3);
  for (std::size_t i = 0; i < plain.passages.size(); ++i)
    for (std::size_t j = 0; j < plain.passages[i].size(); ++j) {
      EXPECT_EQ(wide.passages[i][j].center, plain.passages[i][j].center);
      EXPECT_DOUBLE_EQ(wide.passages[i][j].half_width_m, 1.3 * plain.passages[i][j].half_width_m);
    }
}

TEST(CaveRecipe, ValuesOutOfRangeAreErrors) {
  for (const auto& spoil :
       {+[](CaveRecipe& r) { r.volume_m3 = 10; }, +[](CaveRecipe& r) { r.passage_width_m = 0; },
        +[](CaveRecipe& r) { r.branching = 1.5; }, +[](CaveRecipe& r) { r.loops = -1; },
        +[](CaveRecipe& r) { r.grid_m = 0.01; }, +[](CaveRecipe& r) { r.roughness_m = std::nan(""); }}) {
    CaveRecipe r;
    spoil(r);
    EXPECT_THROW(generate_cave(r, 1), InputError);
  }
}

TEST(CaveRecipe, PresetsAreValidAndUnknownOnesNameTheNearest) {
  for (const std::string& name : cave_presets()) {
    CaveRecipe r = cave_preset(name);
    karst::core::OptionTable table;
    describe(table, r);
    for (const auto& row : table.rows())
      EXPECT_NO_THROW(table.set(name, row.key, karst::core::value_text(row)));
  }
  try {
    cave_preset("mediun");
    FAIL() << "no error";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("did you mean medium?"), std::string::npos) << e.what();
  }
}

}  // namespace
