// Surveys become closed caves of the right size and shape.
#include "sdk/survey_cave/cave_from_survey.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "plugins/simulator/cave/ray_scene.h"
#include "sdk/survey_cave/outline.h"
#include "tests/unit/simulator/meshes.h"
#include "tests/unit/survey_cave/surveys.h"

namespace karst::survey_cave {
namespace {

using core::Vec3;
using test::error_of;
using test::straight_passage;
using test::SurveyMaker;
using test::topology_of;

CaveOptions smooth(double resolution_m = 0.2) {
  CaveOptions o;
  o.resolution_m = resolution_m;
  o.roughness_m = 0;
  return o;
}

CaveFromSurvey made_of(const SurveyMaker& m, const CaveOptions& o = smooth()) {
  return cave_from_survey("test.th", m.survey, o);
}

/// Inside: rays in three slanted directions cross the wall an odd number of times.
void expect_stations_inside(const CaveFromSurvey& made) {
  const cave::RayScene scene(made.mesh);
  for (const KeptStation& s : made.stations)
    for (const Vec3& d : {Vec3(0.3, 0.2, 1), Vec3(1, -0.3, 0.1), Vec3(-0.2, -1, 0.3)})
      EXPECT_EQ(scene.crossings({s.position_m.cast<float>(), d.normalized().cast<float>()}) % 2, 1)
          << s.position_m.transpose();
}

void expect_closed(const CaveFromSurvey& made, std::size_t surfaces, long handles = 0) {
  const test::Topology t = topology_of(made.mesh);
  EXPECT_EQ(t.odd_edges, 0u);
  EXPECT_EQ(t.surfaces, surfaces);
  EXPECT_EQ(t.euler, 2 * static_cast<long>(surfaces) - 2 * handles);
}

TEST(CaveFromSurvey, AStraightPassageHasTheVolumeAndTheWallsOfItsSection) {
  const CaveFromSurvey shorter = made_of(straight_passage(4, 5, 1.5)),
                       longer = made_of(straight_passage(8, 5, 1.5));
  const double metre_m3 = test::superellipse_m2(3, 3);
  EXPECT_NEAR(longer.report.walls.volume_m3 - shorter.report.walls.volume_m3, 20 * metre_m3,
              0.02 * 20 * metre_m3)
      << "the ends are alike";
  for (const core::Vec3f& v : longer.mesh.vertices) {
    if (v.x() < 0 || v.x() > 40) continue;
    const double f = std::pow(std::abs(v.y() / 1.5), kExponent) + std::pow(std::abs(v.z() / 1.5), kExponent);
    EXPECT_NEAR(std::pow(f, 1 / kExponent), 1, 0.03);
  }
  expect_closed(longer, 1);
  expect_stations_inside(longer);
  EXPECT_NEAR(longer.report.passage_m, 40, 1e-9);
}

TEST(CaveFromSurvey, ATaperedPassageHasTheVolumeOfAFrustum) {
  SurveyMaker m = straight_passage(1, 30, 1);
  m.survey.sections[1].dimensions = {3.0, 3.0, 3.0, 3.0};
  const double frustum = test::superellipse_m2(2, 2) * 30 * (1 + 3 + 9) / 3.0;
  const CaveFromSurvey made = made_of(m);
  // Without what lies behind the ends: closed by the plane there, by the divergence theorem.
  double volume = 0;
  const int slices = 300;
  const cave::RayScene scene(made.mesh);
  for (int i = 0; i < slices; ++i) {
    const Vec3 p(30 * (i + 0.5) / slices, 0, 0);
    double twice = 0;
    constexpr int kRays = 180;
    for (int k = 0; k < kRays; ++k) {
      const double a = 2 * std::numbers::pi * k / kRays;
      const double r = scene.ray_cast(p, {0, std::cos(a), std::sin(a)}, 100);
      twice += r * r * 2 * std::numbers::pi / kRays;
    }
    volume += twice / 2 * 30 / slices;
  }
  EXPECT_NEAR(volume, frustum, 0.02 * frustum);
}

TEST(CaveFromSurvey, ABendHasTheVolumeOfItsCentreLine) {
  SurveyMaker straight = straight_passage(2, 12, 1.5), bent = straight;
  bent.survey.stations[2].position_m = {12 + 12 * std::cos(0.8), 12 * std::sin(0.8), 0};
  bent.survey.sections[1].facing = {std::cos(0.4), std::sin(0.4), 0};
  bent.survey.sections[2].facing = {std::cos(0.8), std::sin(0.8), 0};
  const double a = made_of(straight).report.walls.volume_m3, b = made_of(bent).report.walls.volume_m3;
  // The section across the bend is the one measured: across the legs it is narrower by the cosine.
  EXPECT_NEAR(b, a, 0.06 * a);
}

TEST(CaveFromSurvey, ATJunctionIsOneSurfaceLikeABalls) {
  SurveyMaker m = straight_passage(2, 10, 1.5);
  m.station("side.1", {10, 12, 0});
  m.leg(1, 3, 1);
  m.section(3, Vec3::UnitY(), 1, 1, 1, 1, 1);
  const CaveFromSurvey made = made_of(m);
  expect_closed(made, 1);
  expect_stations_inside(made);
  EXPECT_EQ(made.report.parts.size(), 1u);
}

TEST(CaveFromSurvey, ALoopOfPassagesHasOneHandle) {
  SurveyMaker m;
  for (int i = 0; i < 6; ++i) {
    const double a = 2 * std::numbers::pi * i / 6;
    m.station("ring." + std::to_string(i), {10 * std::cos(a), 10 * std::sin(a), 0.5 * i});
    m.section(static_cast<std::uint32_t>(i), Vec3(-std::sin(a), std::cos(a), 0), 1, 1, 1, 1);
  }
  for (std::uint32_t i = 0; i < 6; ++i) m.leg(i, (i + 1) % 6);
  CaveOptions o = smooth();
  o.roughness_m = 0.2;
  expect_closed(made_of(m, o), 1, 1);
}

TEST(CaveFromSurvey, AVerticalPitIsClosedAndAsWideAsMeasured) {
  SurveyMaker m;
  m.station("p.0", {-8, 0, 0}), m.station("p.1", {0, 0, 0}), m.station("p.2", {0, 0, -25});
  m.leg(0, 1), m.leg(1, 2);
  for (const std::uint32_t s : {0u, 1u, 2u}) m.section(s, Vec3::UnitX(), 1.5, 1.5, 2, 1);
  const CaveFromSurvey made = made_of(m);
  expect_closed(made, 1);
  expect_stations_inside(made);
  const cave::RayScene scene(made.mesh);
  EXPECT_NEAR(scene.ray_cast({0, 0, -15}, Vec3::UnitY(), 10), 1.5, 0.1);
  EXPECT_NEAR(scene.ray_cast({0, 0, -15}, Vec3::UnitX(), 10), 1.5, 0.1);
  EXPECT_NEAR(scene.ray_cast({0, 0, -15}, -Vec3::UnitZ(), 20), 11, 0.1) << "down is 1 m below the station";
  EXPECT_NEAR(scene.ray_cast({0, 0, -15}, Vec3::UnitZ(), 30), 17, 0.15) << "up is 2 m above it";
}

TEST(CaveFromSurvey, StationsOnTheWallEndUpInTheAir) {
  SurveyMaker m = straight_passage(3, 6, 1);
  m.survey.sections[1].dimensions = {0.0, 2.0, 2.0, 0.0};
  m.survey.sections[3].dimensions = {2.0, 0.0, 0.0, 2.0};
  CaveOptions o = smooth(0.25);
  o.roughness_m = 0.25;
  for (o.seed = 1; o.seed <= 5; ++o.seed) expect_stations_inside(made_of(m, o));
}

TEST(CaveFromSurvey, PassagesNarrowerThanTheGridStayConnectedAndAreToldOf) {
  SurveyMaker m = straight_passage(3, 6, 1);
  for (auto& s : m.survey.sections) s.dimensions = {0.05, 0.05, 0.2, 0.05};
  m.survey.stations[1].position_m.y() = 2.3;  // not along the grid
  const CaveFromSurvey made = made_of(m, smooth(0.4));
  expect_closed(made, 1);
  EXPECT_NEAR(made.report.dimensions.widened_m, made.report.passage_m, 1e-6);
  EXPECT_NEAR(made.report.obstacles.narrow_m, 0, 1e-6) << "widened to 0.72 m, more than the vehicle's width";
}

TEST(CaveFromSurvey, RoughnessMovesTheWallsByAtMostItsAmplitude) {
  CaveOptions o = smooth(0.2);
  o.roughness_m = 0.3;
  const SurveyMaker m = straight_passage(4, 5, 2);
  const cave::RayScene plain(made_of(m).mesh);
  const CaveFromSurvey rough = made_of(m, o);
  double farthest = 0;
  for (const core::Vec3f& v : rough.mesh.vertices)
    farthest = std::max(farthest, plain.distance_to_rock(v.cast<double>(), 5));
  EXPECT_LT(farthest, 0.3 + 0.05) << "and what the grid rounds";
  EXPECT_GT(farthest, 0.12);
  expect_closed(rough, 1);
}

TEST(CaveFromSurvey, TheSameSeedGivesTheSameBytesAndAnotherSeedOthers) {
  const SurveyMaker m = straight_passage(3, 5, 1.5);
  CaveOptions o;
  o.resolution_m = 0.3;
  const CaveFromSurvey a = made_of(m, o), b = made_of(m, o);
  o.seed = 2;
  const CaveFromSurvey c = made_of(m, o);
  ASSERT_EQ(a.mesh.vertices.size(), b.mesh.vertices.size());
  const std::size_t bytes = a.mesh.vertices.size() * sizeof(core::Vec3f);
  EXPECT_EQ(std::memcmp(a.mesh.vertices.data(), b.mesh.vertices.data(), bytes), 0);
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
  EXPECT_TRUE(c.mesh.vertices.size() != a.mesh.vertices.size() ||
              std::memcmp(a.mesh.vertices.data(), c.mesh.vertices.data(), bytes) != 0);
}

TEST(CaveFromSurvey, LegsWithoutLengthAndStationsAtOnePlaceAreNoTrouble) {
  SurveyMaker m = straight_passage(2, 6, 1.2);
  m.station("same.1", {6, 0, 0}), m.station("same.2", {6, 10, 0}), m.station("lone.1", {0, 50, 0});
  m.station("lone.2", {0, 50, 0});
  m.leg(1, 3, 1), m.leg(3, 4, 1), m.leg(5, 6, 2);
  m.leg(1, 1, 3);
  const CaveFromSurvey made = made_of(m);
  expect_closed(made, 1);
  EXPECT_EQ(made.report.walls.stations_in_rock, 2u);
  EXPECT_EQ(made.report.walls.bare_stations, (std::vector<std::string>{"lone.1", "lone.2"}));
  EXPECT_NEAR(made.report.passage_m, 22, 1e-9);
}

TEST(CaveFromSurvey, SectionsOfARunWithoutLegsAreThoseOfThePassageThroughTheirStation) {
  SurveyMaker m = straight_passage(4, 5, 1.5);
  std::erase_if(m.survey.sections, [](const survey::Section& s) { return s.station == 2; });
  for (auto& s : m.survey.sections) s.run = 7;
  const CaveFromSurvey made = made_of(m);
  EXPECT_EQ(made.report.dimensions.half_width_m, 1.5);
  EXPECT_EQ(made.report.dimensions.defaults_m, 0) << "station 2 is between neighbours that were measured";
}

TEST(CaveFromSurvey, PartsThatAreNotConnectedAreSurfacesOfTheirOwn) {
  SurveyMaker m = straight_passage(2, 6, 1.2);
  m.station("far.1", {0, 30, 0}), m.station("far.2", {8, 30, 0});
  m.leg(3, 4, 1);
  const CaveFromSurvey made = made_of(m);
  expect_closed(made, 2);
  EXPECT_EQ(made.report.parts.size(), 2u);
}

TEST(CaveFromSurvey, StartsNearAnEntranceIfThereIsRoom) {
  SurveyMaker m = straight_passage(10, 8, 1.4);
  m.survey.stations[10].entrance = true;
  const CaveFromSurvey made = made_of(m);
  ASSERT_TRUE(made.start);
  EXPECT_NEAR(made.start->position.x(), 80, 6);
  ASSERT_TRUE(made.report.obstacles.within_reach_m);
  EXPECT_NEAR(*made.report.obstacles.within_reach_m, 80, 1e-6);
}

TEST(CaveFromSurvey, CoordinatesFarFromTheOriginAreMovedByWholeMetres) {
  SurveyMaker m = straight_passage(2, 6, 1.2);
  for (auto& s : m.survey.stations) s.position_m += Vec3(954321.25, 2123456.5, 1800.75);
  const CaveFromSurvey made = made_of(m);
  EXPECT_EQ(made.report.offset_m, Vec3(954327, 2123457, 1800));
  EXPECT_NEAR(made.stations[0].position_m.x() + 954327, 954321.25, 1e-6);
  expect_stations_inside(made);
}

TEST(CaveFromSurvey, TenThousandLegsAreMeshedInBlocksAlongThePassages) {
  SurveyMaker m;
  const int n = 10001;
  for (int i = 0; i < n; ++i)  // a spiral, its turns 20 m apart in height
    m.station("s." + std::to_string(i),
              {60 * std::cos(0.05 * i), 60 * std::sin(0.05 * i), 20 * 0.05 * i / 6.28});
  for (int i = 0; i + 1 < n; ++i) m.leg(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i + 1));
  m.section(0, Vec3::UnitY(), 1, 1, 1, 1);
  const CaveFromSurvey made = made_of(m, smooth(1));
  EXPECT_EQ(made.report.legs, 10000u);
  expect_closed(made, 1);
}

TEST(CaveFromSurvey, TooManyTrianglesAreRefusedWithTheResolutionThatFits) {
  CaveOptions o = smooth(0.2);
  o.max_triangles = 1000;
  const std::string why = error_of([&] { made_of(straight_passage(4, 5, 1.5), o); });
  EXPECT_NE(why.find("--max-triangles 1000"), std::string::npos) << why;
  EXPECT_NE(why.find("--resolution 0."), std::string::npos) << why;
  SurveyMaker wide = straight_passage(3, 5, 1);
  for (auto& s : wide.survey.sections)
    if (s.station == 2) s.dimensions.left_m = 4500;  // for 4.5
  const std::string too_wide = error_of([&] { made_of(wide); });
  EXPECT_NE(too_wide.find("too wide (the widest reaches 45"), std::string::npos) << too_wide;
  EXPECT_NE(too_wide.find("from the leg at cave."), std::string::npos) << too_wide;
  SurveyMaker apart = straight_passage(1, 5, 1);
  apart.station("x.1", {9e6, 0, 0}), apart.station("x.2", {9e6, 9e6, 9e6});
  apart.leg(2, 3);
  EXPECT_NE(error_of([&] { made_of(apart); }).find("test.th: "), std::string::npos);
}

TEST(CaveFromSurvey, AStartInNoPassageIsRefusedWithTheNearestStation) {
  const SurveyMaker m = straight_passage(4, 5, 1.5);
  CaveOptions o = smooth();
  o.start = cave::StartPose{{12, 0, 0}, 0};
  EXPECT_TRUE(made_of(m, o).start);
  o.start = cave::StartPose{{16, 30, 40}, 0};
  const std::string said = error_of([&] { made_of(m, o); });
  EXPECT_NE(said.find("test.th: --start: lies in no passage; the nearest station is 50.0 m away: cave.3 at "
                      "\"15.00 0.00 0.00\""),
            std::string::npos)
      << said;
}

TEST(CaveFromSurvey, WhatLooksWrongInTheSurveyIsAFinding) {
  SurveyMaker m = straight_passage(4, 5, 1.5);
  EXPECT_TRUE(made_of(m).report.findings.empty());
  m.survey.loops.traverses.push_back({"cave.0", "cave.2", 2, 10, 5, 50, 40});
  m.survey.left_out = {2, 3, 25};
  const std::vector<std::string> findings = made_of(m).report.findings;
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_NE(findings[0].find("2 parts of the survey left out"), std::string::npos) << findings[0];
  EXPECT_NE(findings[1].find("50.0 %"), std::string::npos) << findings[1];
}

TEST(CaveFromSurvey, WhatLooksWrongElsewhereIsNoFindingOfAPart) {
  SurveyMaker m = straight_passage(4, 5, 1.5);
  m.leg(4, m.station("far.1", {170, 0, 0}));  // 150 m
  m.survey.loops.traverses.push_back({"far.1", "far.2", 2, 10, 5, 50, 40, {"far.1", "cave.4", "far.2"}});
  const auto says = [](const CaveFromSurvey& made, const std::string& part) {
    return std::any_of(made.report.findings.begin(), made.report.findings.end(),
                       [&](const std::string& f) { return f.find(part) != std::string::npos; });
  };
  CaveOptions o = smooth();
  const CaveFromSurvey whole = made_of(m, o);
  EXPECT_TRUE(says(whole, "50.0 %"));
  EXPECT_TRUE(says(whole, "150"));
  o.part.survey = "cave";
  EXPECT_TRUE(made_of(m, o).report.findings.empty());
  m.survey.loops.traverses.push_back(
      {"far.3", "far.4", 9, 10, 5, 50, 40, {"far.3", "cave.1", "cave.2", "far.4"}});
  EXPECT_TRUE(says(made_of(m, o), "50.0 %")) << "legs of the part lie on that traverse";
}

}  // namespace
}  // namespace karst::survey_cave
