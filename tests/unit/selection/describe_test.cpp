// Figures of caves whose figures are known from how they are drawn.
#include "sdk/selection/describe.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core_stack/common/error.h"
#include "core_stack/mapping/octomap/octomap_io.h"
#include "plugins/simulator/cave_generator/generate_cave.h"
#include "tests/unit/evaluation/reachable/boxes.h"
#include "tests/unit/selection/drawn_space.h"

namespace {

using namespace karst::selection;
using karst::core::InputError;
using karst::core::Vec3;
using karst::test::circle;
using karst::test::either;
using karst::test::Field;
using karst::test::space_of;
using karst::test::tube;

int junctions_of(const CaveFigures& f) {
  return static_cast<int>(std::lround(f.branching * f.length_m / 100));
}
int loops_of(const CaveFigures& f) { return static_cast<int>(std::lround(f.loops * f.length_m / 100)); }

void expect_alike(const CaveFigures& a, const CaveFigures& b, double fraction) {
  for (const FigureDefinition& f : figure_definitions()) {
    const double x = a.*f.value, y = b.*f.value;
    // Of what is counted, one more or less may be seen at another resolution.
    // A junction more may be two dead ends more.
    const double one = f.name == "branching" || f.name == "loops" ? 110 / a.length_m
                       : f.name == "dead_ends"                    ? 220 / a.length_m
                                                                  : 0;
    EXPECT_NEAR(x, y, std::max(one, fraction * std::max(std::abs(x), f.logarithmic ? 0.0 : 0.3))) << f.name;
  }
}

TEST(Describe, LevelTube) {
  const double r = 2;
  const CaveFigures f =
      describe(space_of(tube({{0.1, 0.2, 0.1}, {60.1, 0.2, 0.1}}, r), {-4, -4, -4}, {64, 4, 4}));
  EXPECT_NEAR(f.volume_m3, M_PI * r * r * 60 + 4.0 / 3 * M_PI * r * r * r, 40);  // counted in cells of 0.4 m
  EXPECT_NEAR(f.length_m, 60 + 2 * r, 2.5);
  EXPECT_NEAR(f.width_m, 2 * r, 0.05);
  EXPECT_NEAR(f.width_spread, 1, 0.02);
  EXPECT_NEAR(f.height_m, 2 * r, 0.1);
  EXPECT_NEAR(f.drop_m, 2 * r, 0.5);
  EXPECT_NEAR(f.verticality, 0, 0.02);
  EXPECT_EQ(f.branching, 0);
  EXPECT_EQ(f.loops, 0);
  EXPECT_NEAR(f.tortuosity, 1, 0.02);
}

TEST(Describe, Shaft) {
  const CaveFigures f = describe(space_of(tube({{0, 0, 0}, {0, 0, 50}}, 2.5), {-4, -4, -4}, {4, 4, 54}));
  EXPECT_NEAR(f.verticality, 1, 0.01);
  EXPECT_NEAR(f.drop_m, 55, 0.6);
  EXPECT_EQ(f.branching, 0);
}

TEST(Describe, SlopesInAnyDirectionAreAsSteepAsDrawn) {
  for (const double slope_deg : {15.0, 30.0, 45.0, 60.0})
    for (const double heading_deg : {0.0, 20.0, 45.0, 70.0}) {
      const double s = slope_deg * M_PI / 180, h = heading_deg * M_PI / 180;
      const Vec3 d(std::cos(s) * std::cos(h), std::cos(s) * std::sin(h), std::sin(s));
      const CaveFigures f =
          describe(space_of(tube({Vec3::Zero(), 50 * d}, 2), {-3, -3, -3}, 50 * d + Vec3::Constant(3)));
      EXPECT_NEAR(f.verticality, std::sin(s), 0.04) << slope_deg << " " << heading_deg;
      EXPECT_NEAR(f.tortuosity, 1, 0.05) << slope_deg << " " << heading_deg;
      EXPECT_NEAR(f.length_m, 54, 54 * 0.05) << slope_deg << " " << heading_deg;
      EXPECT_NEAR(f.width_m, 4, 0.1) << slope_deg << " " << heading_deg;
      EXPECT_EQ(junctions_of(f), 0);
    }
}

TEST(Describe, RingIsOneLoopWithoutAJunction) {
  const double R = 15;
  const CaveFigures f =
      describe(space_of(tube(circle(R, 90, Vec3::UnitX(), Vec3::UnitY()), 2), {-18, -18, -3}, {18, 18, 3}));
  EXPECT_EQ(loops_of(f), 1);
  EXPECT_EQ(junctions_of(f), 0);
  // Ways are shortest ways: along the inside of the bend, 0.6 m from its rock.
  EXPECT_NEAR(f.length_m, 2 * M_PI * (R - 1.4), 0.05 * 2 * M_PI * R);
  // Of ways half round and shorter: between 1 and pi / 2.
  EXPECT_GT(f.tortuosity, 1.05);
  EXPECT_LT(f.tortuosity, M_PI / 2);
}

TEST(Describe, TheeIsOneJunctionAndACrossingTwo) {
  const Field line = tube({{-30, 0, 0}, {30, 0, 0}}, 2);
  const CaveFigures t =
      describe(space_of(either(line, tube({{0, 0, 0}, {0, 25, 0}}, 2)), {-33, -3, -3}, {33, 28, 3}));
  EXPECT_EQ(junctions_of(t), 1);
  EXPECT_EQ(loops_of(t), 0);
  EXPECT_NEAR(t.length_m, 85, 8);
  const CaveFigures x =
      describe(space_of(either(line, tube({{0, -25, 0}, {0, 25, 0}}, 2)), {-33, -28, -3}, {33, 28, 3}));
  EXPECT_EQ(junctions_of(x), 2);
  EXPECT_EQ(loops_of(x), 0);
}

TEST(Describe, TwoLevelsJoinedByTwoShaftsAreALoop) {
  // Galleries of 60 m, 20 m above each other; shafts 10 m from either end.
  Field f = either(tube({{0, 0, 0}, {60, 0, 0}}, 2), tube({{0, 0, 20}, {60, 0, 20}}, 2));
  f = either(f, either(tube({{10, 0, 0}, {10, 0, 20}}, 1.6), tube({{50, 0, 0}, {50, 0, 20}}, 1.6)));
  const CaveFigures d = describe(space_of(f, {-3, -3, -3}, {63, 3, 23}));
  EXPECT_EQ(loops_of(d), 1);
  EXPECT_EQ(junctions_of(d), 4);
  EXPECT_NEAR(d.verticality, 40.0 / 160, 0.08);
  EXPECT_NEAR(d.drop_m, 24, 0.9);  // cells of 0.4 m at either end
}

TEST(Describe, GridOfPassagesHasAsManyLoopsAsMeshes) {
  // Three by four streets, 18 m apart: 3 x 4 crossings, (3 - 1) x (4 - 1) = 6 blocks to go round. The four
  // corners are bends, six crossings at the rim have three ways, two have four: 6 + 2 x 2 junctions.
  Field f = tube({{0, 0, 0}, {54, 0, 0}}, 1.8);
  for (int y = 1; y < 3; ++y) f = either(f, tube({{0, 18.0 * y, 0}, {54, 18.0 * y, 0}}, 1.8));
  for (int x = 0; x < 4; ++x) f = either(f, tube({{18.0 * x, 0, 0}, {18.0 * x, 36, 0}}, 1.8));
  const CaveFigures d = describe(space_of(f, {-3, -3, -3}, {57, 39, 3}));
  EXPECT_EQ(loops_of(d), 6);
  EXPECT_EQ(junctions_of(d), 10);
}

TEST(Describe, PillarsAndAlcovesSmallerThanThePassageAreNeitherLoopsNorBranches) {
  Field f = tube({{0, 0, 0}, {60, 0, 0}}, 3);
  for (const double x : {15.0, 30.0, 45.0}) f = karst::test::without_ball(f, {x, 0, 0}, 0.9);
  for (const double x : {20.0, 40.0}) f = either(f, tube({{x, 0, 0}, {x, 4.0, 0}}, 1.2));
  const CaveFigures d = describe(space_of(f, {-4, -6, -4}, {64, 6, 4}));
  EXPECT_EQ(loops_of(d), 0);
  EXPECT_EQ(junctions_of(d), 0);
}

TEST(Describe, WidthOfAPassageThatWidensIsItsMedianAndItsSpread) {
  // A cone from 1.5 to 4.5 m radius: the median radius is 3, and nine tenths over one tenth is 4.2 / 1.8.
  const Field f = [](const Vec3& p) {
    const double x = std::clamp(p.x(), 0.0, 80.0);
    const double slope = std::atan(3.0 / 80);
    return std::min((1.5 + 3.0 * x / 80 - std::hypot(p.y(), p.z())) * std::cos(slope),
                    std::min(p.x() + 1, 81 - p.x()));
  };
  const CaveFigures d = describe(space_of(f, {-2, -5, -5}, {82, 5, 5}));
  EXPECT_NEAR(d.width_m, 6, 0.3);
  EXPECT_NEAR(d.width_spread, 4.2 / 1.8, 0.25);
}

TEST(Describe, ZigzagIsAsTortuousAsDrawn) {
  // Legs of 14 m at 45 degrees to either side: sqrt(2) times the straight line, less what the corners cut
  // off.
  std::vector<Vec3> line;
  for (int i = 0; i < 9; ++i) line.push_back({9.9 * i, i % 2 ? 9.9 : 0.0, 0});
  const CaveFigures d = describe(space_of(tube(line, 1.6), {-3, -3, -3}, {83, 13, 3}));
  EXPECT_GT(d.tortuosity, 1.2);
  EXPECT_LT(d.tortuosity, std::sqrt(2.0) + 0.03);
}

TEST(Describe, RoomIsAPassageOfItsOwnLength) {
  const Field ball = [](const Vec3& p) { return 6 - p.norm(); };
  const CaveFigures d = describe(space_of(ball, {-7, -7, -7}, {7, 7, 7}));
  EXPECT_NEAR(d.length_m, 12, 3);
  EXPECT_EQ(d.branching, 0);
  EXPECT_EQ(d.loops, 0);
  EXPECT_EQ(d.tortuosity, 1);
}

TEST(Describe, SmallestSpaceThereIs) {
  const Field hole = [](const Vec3& p) { return 0.7 - (p - Vec3(0.2, 0.2, 0.2)).norm(); };
  const CaveFigures d = describe(space_of(hole, {-1, -1, -1}, {1, 1, 1}));
  EXPECT_NEAR(d.width_m, 1.4, 0.05);
  EXPECT_EQ(d.branching, 0);
  EXPECT_EQ(d.loops, 0);
  for (const FigureDefinition& f : figure_definitions())
    EXPECT_TRUE(f.name == "verticality" || std::isfinite(d.*f.value)) << f.name;
}

TEST(Describe, BoxOfAMeshHasItsVolumeAtAnyPlaceOnTheGrid) {
  std::set<std::array<int, 3>> cells;
  karst::test::fill(cells, {0, 0, 0}, {30, 4, 3});
  for (const double offset : {0.03, 0.07, 0.13}) {
    const karst::cave::RayScene scene(karst::test::lattice_mesh(cells, 1.0, Vec3::Constant(offset)));
    const FreeSpace s = free_space_of(scene, Vec3(2, 2, 1.5), {}, "box");
    EXPECT_NEAR(s.volume_m3, 360, 0.03 * 360) << offset;
    const CaveFigures f = describe(s);
    EXPECT_NEAR(f.width_m, 3, 0.05) << offset;
    EXPECT_NEAR(f.height_m, 3, 0.05) << offset;
  }
}

karst::cave::GeneratedCave cave_of(const std::string& preset, int seed) {
  karst::cave::CaveRecipe recipe = karst::cave::cave_preset(preset);
  recipe.volume_m3 = 3000;
  recipe.grid_m = 0.4;
  return karst::cave::generate_cave(recipe, static_cast<std::uint64_t>(seed), [](const char*, double) {});
}

TEST(Describe, GeneratedCaveIsTheSameFromAnyStartAndAtOtherResolutions) {
  const karst::cave::GeneratedCave cave = cave_of("medium", 3);
  const karst::cave::RayScene scene(cave.mesh);
  const Vec3 start = cave.start.position;
  const CaveFigures f = describe(free_space_of(scene, start, {}, "cave"));
  EXPECT_NEAR(f.volume_m3, 3000, 0.1 * 3000);
  // Another start: some other place that can be flown to.
  const FreeSpace space = free_space_of(scene, start, {}, "cave");
  std::vector<Vec3> places;
  space.flyable.for_each(
      [&](const karst::core::CellKey& k) { places.push_back(0.4 * Vec3(k.x + 0.5, k.y + 0.5, k.z + 0.5)); });
  for (const std::size_t i : {places.size() / 3, places.size() - 1}) {
    Vec3 p = places[i];
    if (space.distance_to_rock(p) < 0.6) continue;
    const CaveFigures other = describe(free_space_of(scene, p, {}, "cave"));
    EXPECT_EQ(to_json(other), to_json(f));
  }
  for (const double coarse : {0.6, 0.8}) {
    FreeSpaceOptions o;
    o.coarse_m = coarse;
    expect_alike(describe(free_space_of(scene, start, o, "cave")), f, 0.15);
  }
}

TEST(Describe, KindsOfGeneratedCavesDifferAsTheirNamesSay) {
  const auto figures = [](const std::string& preset) {
    const karst::cave::GeneratedCave c = cave_of(preset, 1);
    return describe(free_space_of(karst::cave::RayScene(c.mesh), c.start.position, {}, preset));
  };
  const CaveFigures maze = figures("maze"), vertical = figures("vertical"), small = figures("small");
  EXPECT_GT(vertical.verticality, maze.verticality + 0.15);
  EXPECT_GT(vertical.drop_m, 2 * maze.drop_m);
  EXPECT_GT(maze.branching, small.branching);
  EXPECT_GT(maze.loops, vertical.loops);
}

/// The map that a perfect flight makes of a space: free inside, a layer of rock around it.
karst::core::VoxelMap map_of(const Field& field, const Vec3& low, const Vec3& high) {
  karst::core::VoxelMap map{karst::core::MapOptions{}};
  const auto a = map.key_of(low), b = map.key_of(high);
  for (karst::core::CellKey k{0, 0, a.z}; k.z <= b.z; ++k.z)
    for (k.y = a.y; k.y <= b.y; ++k.y)
      for (k.x = a.x; k.x <= b.x; ++k.x)
        if (const double d = field(map.center_of(k)); d > -0.12) map.assign(k, 1, d > 0.12 ? -2.0f : 2.0f);
  return map;
}

TEST(Describe, MapOfASpaceReadsLikeTheSpaceItself) {
  const Field f = either(tube({{-30, 0, 0}, {30, 0, 6}}, 2), tube({{0, 0, 3}, {0, 25, 3}}, 2.4));
  const Vec3 low(-33, -4, -4), high(33, 28, 10);
  const karst::core::VoxelMap map = map_of(f, low, high);
  const CaveFigures of_map = describe(free_space_of(map, {}, "map"));
  const CaveFigures of_space = describe(space_of(f, low, high));
  expect_alike(of_map, of_space, 0.12);
  EXPECT_EQ(junctions_of(of_map), 1);
}

TEST(Describe, GapsBetweenRaysAreNoRock) {
  const Field f = tube({{0, 0, 0}, {40, 0, 0}}, 2.5);
  karst::core::VoxelMap whole = map_of(f, {-4, -4, -4}, {44, 4, 4});
  karst::core::VoxelMap sieve{karst::core::MapOptions{}};
  std::size_t n = 0;
  whole.for_each_known([&](const karst::core::CellKey& k, karst::core::Cell c, float v) {
    if (c == karst::core::Cell::occupied || n++ % 29 != 0) sieve.assign(k, 1, v);
  });
  expect_alike(describe(free_space_of(sieve, {}, "sieve")), describe(free_space_of(whole, {}, "whole")),
               0.08);
}

TEST(Describe, MapsWithNothingToFlyInAreErrors) {
  const auto message = [](const karst::core::VoxelMap& map) -> std::string {
    try {
      free_space_of(map, {}, "empty.bt");
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  karst::core::VoxelMap map{karst::core::MapOptions{}};
  EXPECT_NE(message(map).find("empty.bt: the map has no free cell"), std::string::npos);
  map.assign({0, 0, 0}, 4, 2.0f);
  EXPECT_NE(message(map).find("no free cell"), std::string::npos);
  map.assign({8, 0, 0}, 2, -2.0f);
  EXPECT_NE(message(map).find("no place to fly"), std::string::npos);
}

TEST(Describe, FilesThatAreNoneAreErrors) {
  namespace fs = std::filesystem;
  const fs::path dir = fs::path(testing::TempDir()) / "describe_files";
  fs::create_directories(dir);
  const auto message = [&](const std::string& name, const std::string& content,
                           const std::string& start = "") -> std::string {
    std::ofstream(dir / name) << content;
    try {
      describe_file((dir / name).string(), start);
    } catch (const InputError& e) {
      return e.what();
    }
    return "accepted";
  };
  EXPECT_NE(message("cut.bt", "# Octomap OcTree binary file\nid OcTree\nsize 9\n").find("cut.bt"),
            std::string::npos);
  EXPECT_NE(message("empty.ply", "").find("empty.ply"), std::string::npos);
  EXPECT_NE(message("bare.stl", "solid x\nendsolid x\n", "0 0 1").find("bare.stl"), std::string::npos);
  EXPECT_NE(message("odd.info", "widht \"4 m\"\n").find("did you mean width?"), std::string::npos);
  EXPECT_NE(message("neg.info", "width \"-4 m\"\n").find("expected a number in 0.5 to 500 m"),
            std::string::npos);
  EXPECT_NE(message("nan.info", "verticality nan\n").find("verticality"), std::string::npos);
  EXPECT_NE(message("unit.info", "volume \"4 m\"\n").find("no unit for it"), std::string::npos);
  EXPECT_NE(message("none.info", "; nothing\n").find("gives no figure"), std::string::npos);
  EXPECT_NE(message("start.info", "width 4\n", "1 2 3").find("of use with a mesh only"), std::string::npos);
  EXPECT_NE(message("lost.info", "mesh nowhere.ply\nstart \"0 0 1\"\n").find("nowhere.ply"),
            std::string::npos);
  EXPECT_THROW(describe_file((dir / "none").string(), ""), InputError);
  const fs::path some = dir / "some.info";
  std::ofstream(some) << "width \"400 cm\"\nloops 2\n";
  const Description d = describe_file(some.string(), "");
  EXPECT_EQ(d.source, Source::numbers);
  EXPECT_EQ(d.figures.width_m, 4);
  EXPECT_EQ(d.figures.loops, 2);
  EXPECT_TRUE(std::isnan(d.figures.volume_m3));
}

TEST(CaveFigures, SurviveJson) {
  CaveFigures f;
  f.volume_m3 = 1234.5678;
  f.loops = 0;
  const CaveFigures g = figures_from_json(to_json(f), "store");
  EXPECT_EQ(g.volume_m3, 1234.57);
  EXPECT_EQ(g.loops, 0);
  EXPECT_TRUE(std::isnan(g.width_m));
  EXPECT_EQ(to_json(g), to_json(f));
  EXPECT_EQ(to_json(figures_from_json("", "store")), "{}");
  EXPECT_THROW(figures_from_json("[1]", "store"), InputError);
  EXPECT_THROW(figures_from_json("{\"width\": \"wide\"}", "store"), InputError);
  EXPECT_THROW(figures_from_json("{\"width\": -1}", "store"), InputError);
}

}  // namespace
