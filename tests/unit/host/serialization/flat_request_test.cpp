// A request as bytes: what comes out is what went in, and what was not written so is refused.
#include "sdk/host/serialization/flat_request.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cstring>

#include "core_stack/mapping/occupancy/voxel_classes.h"
#include "sdk/host/services/translation.h"
#include "tests/abi/room.h"

namespace karst::test {
namespace {

using core::Cell;
using core::CellKey;
using core::Vec3;
using host::flatten;
using host::RequestReader;
using ::testing::HasSubstr;

/// What read() throws; "" if it reads.
std::string refusal(std::span<const std::byte> bytes) {
  RequestReader reader(RequestReader::Keeps::map);
  try {
    reader.read(bytes);
  } catch (const host::FlatError& e) {
    return e.what();
  }
  return "";
}

void expect_same_cells(const core::VoxelMap& a, const core::VoxelMap& b) {
  std::vector<std::pair<CellKey, Cell>> in_a, in_b;
  a.for_each_known([&](const CellKey& k, Cell c, float) { in_a.emplace_back(k, c); });
  b.for_each_known([&](const CellKey& k, Cell c, float) { in_b.emplace_back(k, c); });
  EXPECT_EQ(in_a, in_b);
  EXPECT_EQ(a.free_cells(), b.free_cells());
  EXPECT_EQ(a.occupied_cells(), b.occupied_cells());
  EXPECT_EQ(a.revision(), b.revision());
}

TEST(FlatRequest, WhatThePolicySeesIsTheSame) {
  Room room;
  core::CameraModel camera;
  camera.name = "front";
  camera.horizontal_fov_rad = 1.4;
  camera.vertical_fov_rad = 1.1;
  camera.T_body_camera.position = {0.1, 0, -0.05};
  room.vehicle.cameras.push_back(std::make_shared<core::CameraModel>(camera));
  room.vehicle.rgb = std::make_shared<core::RgbCameraModel>(core::RgbCameraModel{camera, 1.1});
  const core::ImagedSurface imaged(std::vector<CellKey>{{3, -4, 5}, {0, 0, 1}});
  room.request.imaged = &imaged;
  room.request.max_acceleration_mps2 = 3.5;
  room.request.battery_fraction = 0.7;
  room.request.battery_seconds_left = 812.5;
  room.request.mission_seconds_left = std::numeric_limits<double>::infinity();
  room.request.last_fate = core::GoalFate::abandoned;
  room.request.last_goal = {1, 2, 3};
  room.request.state.orientation = core::Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
  room.request.frontiers[0].path_length_m = std::numeric_limits<double>::infinity();
  room.request.teammates = {{1, -5, {1, 2, 3}, {0.1, 0, 0}, Vec3(7, 8, 9), 12.5},
                            {4, 6, {-1, 0, 2}, {0, 0, 0}, std::nullopt, 0}};
  RequestReader reader(RequestReader::Keeps::map);
  const core::DecisionRequest& read = reader.read(flatten(room.request));
  expect_same_cells(*read.map, room.map);
  EXPECT_EQ(read.roadmap, nullptr);
  EXPECT_EQ(read.frontiers[0].cluster->cells, room.window.cells);

  const host::RequestPack a(room.request, nullptr), b(read, nullptr);
  karst_request_t x = a.request(), y = b.request();
  EXPECT_EQ(read.max_acceleration_mps2, 3.5) << "for the flight times of paths";
  EXPECT_EQ(y.battery_fraction, 0.7);
  EXPECT_EQ(y.battery_seconds_left, 812.5);
  EXPECT_EQ(y.mission_seconds_left, std::numeric_limits<double>::infinity());
  ASSERT_NE(read.imaged, nullptr);
  EXPECT_EQ(read.imaged->cells(), imaged.cells());
  EXPECT_EQ(read.vehicle->rgb->max_incidence_rad, 1.1);
  ASSERT_EQ(x.sensor_count, 3u);
  ASSERT_EQ(y.sensor_count, 3u);
  ASSERT_EQ(y.frontier_count, 1u);
  EXPECT_EQ(std::memcmp(x.frontiers, y.frontiers, sizeof *x.frontiers), 0);
  for (std::uint32_t i = 0; i < 3; ++i) {
    karst_sensor_t s = x.sensors[i], t = y.sensors[i];
    EXPECT_EQ(std::string(s.name.data, s.name.length), std::string(t.name.data, t.name.length));
    s.name = t.name = {};
    EXPECT_EQ(std::memcmp(&s, &t, sizeof s), 0);
  }
  ASSERT_EQ(x.teammate_count, 2u);
  ASSERT_EQ(y.teammate_count, 2u);
  EXPECT_EQ(std::memcmp(x.teammates, y.teammates, 2 * sizeof *x.teammates), 0);
  EXPECT_EQ(y.teammates[0].stamp_ns, -5);
  EXPECT_EQ(y.teammates[0].goal.y, 8);
  EXPECT_TRUE(std::isnan(y.teammates[1].goal.x)) << "it has none";
  x.teammates = y.teammates = nullptr;
  x.sensors = y.sensors = nullptr;
  x.frontiers = y.frontiers = nullptr;
  EXPECT_EQ(std::memcmp(&x, &y, sizeof x), 0);
}

core::SurveyedPassages survey() {
  return core::SurveyedPassages({{{0, 0, 0}, {10, 1, 0}, {20, 0, -5}},
                                 {{0, 1, {1, 2, 3, 4}, {0.5, 0, 1, 1}}, {1, 2, {0.5, 0, 1, 1}, {2, 2, 2, 2}}},
                                 {{1, true}, {2, false}}});
}

TEST(FlatRequest, TheSurveyIsTheSameAndWrittenWithAWholeMapOnly) {
  Room room;
  const core::SurveyedPassages known = survey();
  const std::size_t without = flatten(room.request).size();
  room.request.survey = &known;
  const host::Bytes whole = flatten(room.request), changes = flatten(room.request, room.map.revision());
  EXPECT_EQ(whole.size() - without, 1u + 3 * 8u + 3 * 24u + 2 * 72u + 2 * 5u);
  EXPECT_THAT(refusal(changes), HasSubstr("is not here"));
  RequestReader reader(RequestReader::Keeps::map);
  for (const host::Bytes& bytes : {whole, changes}) {
    const core::SurveyedPassages* read = reader.read(bytes).survey;
    ASSERT_NE(read, nullptr);
    const core::SurveyPrior& p = read->prior();
    EXPECT_EQ(p.stations, known.prior().stations);
    ASSERT_EQ(p.legs.size(), 2u);
    EXPECT_EQ(p.legs[1].from, 1u);
    EXPECT_EQ(p.legs[1].to, 2u);
    EXPECT_EQ(p.legs[0].from_size.down_m, 4);
    EXPECT_EQ(p.legs[0].to_size.right_m, 0);
    ASSERT_EQ(p.leads.size(), 2u);
    EXPECT_TRUE(p.leads[0].noted && !p.leads[1].noted);
    EXPECT_EQ(read->distance_m({5, 7, 1}), known.distance_m({5, 7, 1}));
  }
  room.request.survey = nullptr;
  EXPECT_EQ(reader.read(flatten(room.request, room.map.revision())).survey, nullptr);
}

TEST(FlatRequest, ASurveyWithoutSenseIsRefused) {
  Room room;
  const core::SurveyedPassages known = survey();
  room.request.survey = &known;
  host::Bytes bytes = flatten(room.request);
  const std::uint32_t nowhere = 3;  // the last lead's station
  std::memcpy(bytes.data() + bytes.size() - 5, &nowhere, sizeof nowhere);
  host::seal(bytes);
  EXPECT_THAT(refusal(bytes), HasSubstr("the survey is none"));
}

TEST(FlatRequest, WithoutMapVehicleAndFrontiersIsARequestToo) {
  core::DecisionRequest bare;
  bare.sequence = 9;
  RequestReader reader(RequestReader::Keeps::map_and_roadmap);
  const core::DecisionRequest& read = reader.read(flatten(bare));
  EXPECT_EQ(read.sequence, 9u);
  EXPECT_EQ(read.map, nullptr);
  EXPECT_EQ(read.vehicle, nullptr);
  EXPECT_TRUE(read.frontiers.empty());
}

/// Cells drawn one after the other into a map and a roadmap; the reader gets what changed.
TEST(FlatRequest, ChangesAddUpToTheMapAndItsRoadmap) {
  EXPECT_TRUE(rc::check([] {
    core::VoxelMap map(core::MapOptions{});
    core::Roadmap roadmap(core::PlanningOptions{.clearance_m = 0.3});
    core::DecisionRequest request;
    request.map = &map, request.roadmap = &roadmap;
    RequestReader reader(RequestReader::Keeps::map_and_roadmap);
    std::uint64_t since = 0;
    const int steps = *rc::gen::inRange(1, 5);
    for (int step = 0; step < steps; ++step) {
      const Vec3 at(*rc::gen::inRange(-30, 30) * 0.1, *rc::gen::inRange(-30, 30) * 0.1, 0);
      std::vector<core::CellChange> changes = map.declare_free(at, 1.5);
      std::vector<core::Ray> rays;
      for (int i = *rc::gen::inRange(0, 20); i > 0; --i)
        rays.push_back({at.cast<float>(),
                        core::Vec3f(static_cast<float>(*rc::gen::inRange(-400, 400)) * 0.01f,
                                    static_cast<float>(*rc::gen::inRange(-400, 400)) * 0.01f, 0.3f),
                        true});
      for (int scan = 0; scan < 3; ++scan)
        for (const core::CellChange& c : map.insert(rays)) changes.push_back(c);
      roadmap.update(map, changes);
      const core::DecisionRequest& read = reader.read(flatten(request, since));
      since = map.revision();
      expect_same_cells(*read.map, map);
      RC_ASSERT(read.roadmap->node_count() == roadmap.node_count());
      const std::vector<Vec3> goals = {{0, 0, 0}, {1.5, 1.5, 0.1}, {-2, 1, 0}, at};
      RC_ASSERT(read.roadmap->distances(*read.map, at, goals, 0.5) == roadmap.distances(map, at, goals, 0.5));
    }
    RC_ASSERT(!::testing::Test::HasFailure());
  }));
}

TEST(FlatRequest, OnlyWhatChangedIsWritten) {
  Room room;
  const std::size_t whole = flatten(room.request).size();
  const std::uint64_t before = room.map.revision();
  const std::size_t nothing = flatten(room.request, before).size();
  room.map.assign({10, 4, 4}, 1, -2.0f);
  const std::size_t one_block = flatten(room.request, before).size();
  EXPECT_EQ(one_block - nothing, 12u + 128u);
  EXPECT_EQ(whole - nothing, 27u * (12u + 128u));  // -1 to 10 in each axis touches 3 x 3 x 3 blocks
}

TEST(FlatRequest, ChangesOfAMapNotHeldAreRefused) {
  Room room;
  EXPECT_THAT(refusal(flatten(room.request, room.map.revision())), HasSubstr("is not here"));
  RequestReader reader(RequestReader::Keeps::map);
  reader.read(flatten(room.request));
  const host::Bytes late = flatten(room.request, room.map.revision() - 1);
  EXPECT_THROW(reader.read(late), host::FlatError);
  // And then nothing is held any more.
  EXPECT_THROW(reader.read(flatten(room.request, room.map.revision())), host::FlatError);
  EXPECT_NO_THROW(reader.read(flatten(room.request)));
}

TEST(FlatRequest, CutShortAnywhereIsRefused) {
  Room room;
  const host::Bytes bytes = flatten(room.request);
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_NE(refusal({bytes.data(), n}), "") << n << " of " << bytes.size() << " bytes";
  EXPECT_EQ(refusal(bytes), "");
  host::Bytes longer = bytes;
  longer.push_back({});
  EXPECT_THAT(refusal(longer), HasSubstr("byte 32: it should hold"));
}

TEST(FlatRequest, AnyDamagedByteIsNoticed) {
  Room room;
  const host::Bytes bytes = flatten(room.request);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (i >= 12 && i < 16) continue;  // reserved
    host::Bytes bad = bytes;
    bad[i] ^= std::byte{0x10};
    EXPECT_NE(refusal(bad), "") << "byte " << i;
  }
}

TEST(FlatRequest, OtherVersionIsNamed) {
  Room room;
  host::Bytes bytes = flatten(room.request);
  bytes[8] = std::byte{7};
  EXPECT_THAT(refusal(bytes), HasSubstr("version 7, this karst reads version 5"));
}

TEST(FlatRequest, BlocksAreSoundOnlyInTheWorldAndInPlace) {
  core::ClassBlock b{};
  EXPECT_TRUE(core::is_sound(b));
  b.low = {8, -16, 32760};
  EXPECT_TRUE(core::is_sound(b));
  b.low = {4, 0, 0};
  EXPECT_FALSE(core::is_sound(b));
  b.low = {0, 0, 32768};
  EXPECT_FALSE(core::is_sound(b));
  b.low = {};
  b.classes[100] = 0b10011000;
  EXPECT_TRUE(core::is_sound(b));
  b.classes[100] = 0b00001100;
  EXPECT_FALSE(core::is_sound(b));
}

}  // namespace
}  // namespace karst::test
