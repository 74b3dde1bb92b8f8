#include "sdk/cave_drawing/map_drawings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "sdk/cave_drawing/svg_sheet.h"
#include "tests/unit/cave_drawing/box_maps.h"
#include "tests/unit/cave_drawing/drawn_lines.h"

namespace karst::cave_drawing {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

core::VoxelMap tunnel() { return test::map_of_boxes({{{0, 0, 0}, {199, 14, 14}}}); }

FlightRecord record_of() {
  FlightRecord record;
  record.name = "tunnel";
  record.from = "flight";
  record.entrance = core::Vec3(1.5, 1.5, 0.5);
  record.path = {{1.5, 1.5, 0.5}, {30, 1.5, 1.5}};
  record.finds = {{"helmet", {20, 1, 0.2}}};
  return record;
}

TEST(MapDrawings, EntranceFindsAndPathAreDrawnWhereTheyAre) {
  const CaveDrawings drawings = map_drawings(tunnel(), record_of(), std::numbers::pi / 2, "map");
  for (const Drawing* d : {&drawings.plan, &drawings.extended, &drawings.projected}) {
    EXPECT_EQ(test::count_of(*d, Mark::Kind::entrance), 1);
    EXPECT_EQ(test::count_of(*d, Mark::Kind::find), 1);
    for (const Mark& m : d->marks)
      if (m.kind == Mark::Kind::find) {
        EXPECT_EQ(m.text, "helmet");
      }
  }
  for (const Mark& m : drawings.projected.marks)
    if (m.kind == Mark::Kind::find) {
      EXPECT_NEAR(m.at.x(), 18.5, 1e-9) << "along the tunnel, from the entrance";
      EXPECT_NEAR(m.at.y(), -0.3, 1e-9);
    }
  ASSERT_EQ(drawings.plan.paths.size(), 1u);
  EXPECT_EQ(drawings.plan.paths[0][1], Point(30, 1.5));
  EXPECT_TRUE(drawings.extended.paths.empty());
}

TEST(MapDrawings, TheRegionOfTheFlightIsDrawnInPlanAndProfile) {
  core::FlightRegion::Limits limits;
  limits.keep_in = core::box({5, -20, -50}, {30, 20, 2.5});
  limits.keep_out = {{{{10, 0}, {12, 0}, {11, 2}}, 0.5, 1}};
  FlightRecord record = record_of();
  record.region = std::make_shared<const core::FlightRegion>(limits);
  const double entrance_z = record.entrance->z(), entrance_x = record.entrance->x();
  const CaveDrawings drawings = map_drawings(tunnel(), record, std::numbers::pi / 2, "map");
  ASSERT_EQ(drawings.plan.keep_in.size(), 1u);
  EXPECT_EQ(drawings.plan.keep_out, (std::vector<Line>{{{10, 0}, {12, 0}, {11, 2}, {10, 0}}}));
  ASSERT_EQ(drawings.projected.keep_in.size(), 1u);
  EXPECT_EQ(drawings.projected.keep_out.size(), 1u);
  const Line& aside = drawings.projected.keep_in[0];
  EXPECT_NEAR((aside[2] - Point(30 - entrance_x, 2.5 - entrance_z)).norm(), 0, 1e-9);
  EXPECT_NEAR((aside[0] - Point(5 - entrance_x, 0 - entrance_z)).norm(), 0, 0.41) << "it ends with the map";
  EXPECT_EQ(drawings.plan.walls, map_drawings(tunnel(), record_of(), {}, "map").plan.walls);
  const std::string page = svg_sheet(drawings.plan, drawings.facts, {}, "map");
  for (const char* part : {"class=\"keep-in\"", "class=\"keep-out\"", "class=\"keep-out-hatching\"",
                           "green dash-dotted: keep in, red hatched: keep out"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_EQ(
      svg_sheet(map_drawings(tunnel(), record_of(), {}, "map").plan, drawings.facts, {}, "map").find("clip"),
      std::string::npos);
}

TEST(MapDrawings, TheFiguresAreThoseOfTheRoom) {
  const CaveFacts facts = map_drawings(tunnel(), record_of(), {}, "map").facts;
  EXPECT_EQ(facts.name, "tunnel");
  EXPECT_NEAR(facts.floor_to_roof_m.value_or(0), 3, 1e-9);
  EXPECT_FALSE(facts.depth_m) << "a survey's, from station to station";
  EXPECT_NEAR(facts.volume_m3.value_or(0), 200 * 15 * 15 * 0.008, 1e-6);
  EXPECT_NEAR(facts.length_m.value_or(0), 40, 4);
}

TEST(MapDrawings, WallsOfRockAreCertain) {
  const CaveDrawings drawings = map_drawings(tunnel(), record_of(), {}, "map");
  for (const Drawing* d : {&drawings.plan, &drawings.extended, &drawings.projected})
    EXPECT_TRUE(d->uncertain_walls.empty()) << core::name_of(d->view);
}

TEST(MapDrawings, AnEndWithoutAWallIsAskedAboutAndOneAtRockIsNot) {
  EXPECT_EQ(test::count_of(map_drawings(tunnel(), record_of(), {}, "map").plan, Mark::Kind::unknown_end), 0);
  core::VoxelMap open{core::MapOptions{}};
  for (int x = -2; x <= 199; ++x)
    for (int y = -2; y <= 16; ++y)
      for (int z = -2; z <= 16; ++z) {
        const bool free = x >= 0 && y >= 0 && y < 15 && z >= 0 && z < 15;
        open.assign({x, y, z}, 1, free ? -2.0f : 2.0f);
      }
  const CaveDrawings drawings = map_drawings(open, record_of(), {}, "map");
  ASSERT_EQ(test::count_of(drawings.plan, Mark::Kind::unknown_end), 1);
  EXPECT_EQ(test::count_of(drawings.extended, Mark::Kind::unknown_end), 1);
  for (const Mark& m : drawings.plan.marks)
    if (m.kind == Mark::Kind::unknown_end) {
      EXPECT_NEAR(m.at.x(), 40, 0.5) << "where it is lost sight of";
    }
  // The limit of sight is no wall: all of the end is uncertain, and nothing but it.
  const CaveDrawings east = map_drawings(open, record_of(), std::numbers::pi / 2, "map");
  for (const auto& [drawing, entrance_m] :
       {std::pair{&east.plan, 0.0}, {&east.projected, 1.5}, {&east.extended, 1.5}}) {
    ASSERT_FALSE(drawing->uncertain_walls.empty()) << core::name_of(drawing->view);
    EXPECT_NEAR(test::span_of(drawing->uncertain_walls, 1).length(), 3, 1.0);
    if (drawing != &east.extended) {
      EXPECT_NEAR(test::span_of(drawing->uncertain_walls, 0).low, 40 - entrance_m, 0.8);
    }
  }
}

TEST(MapDrawings, AMapAloneHasNoEntrance) {
  const CaveDrawings drawings = map_drawings(tunnel(), {}, {}, "map");
  EXPECT_EQ(test::count_of(drawings.plan, Mark::Kind::entrance), 0);
  EXPECT_FALSE(drawings.extended.spaces.empty());
}

TEST(MapDrawings, WhatIsNoNumberIsRefused) {
  const core::VoxelMap map = tunnel();
  FlightRecord entrance = record_of(), path = record_of(), find = record_of();
  entrance.entrance->x() = kNan;
  path.path[1].y() = kNan;
  find.finds[0].position.z() = kNan;
  for (const FlightRecord& bad : {entrance, path, find})
    EXPECT_NE(test::refusal_by([&] { map_drawings(map, bad, {}, "a.bt"); }).find("not a number"),
              std::string::npos);
  EXPECT_NE(test::refusal_by([&] { map_drawings(map, record_of(), kNan, "a.bt"); }).find("bearing"),
            std::string::npos);
  EXPECT_NE(test::refusal_by([&] {
              map_drawings(core::VoxelMap{core::MapOptions{}}, {}, {}, "a.bt");
            }).find("no free cell"),
            std::string::npos);
}

}  // namespace
}  // namespace karst::cave_drawing
