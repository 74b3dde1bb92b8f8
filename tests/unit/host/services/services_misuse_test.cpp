// Services called as a careless plugin would: the host answers with an error and stays as it was.
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "sdk/abi/karst_abi.h"
#include "sdk/host/services/session.h"

namespace karst::host {
namespace {

struct Asked : ::testing::Test {
  core::VoxelMap map{core::MapOptions{}};
  core::Roadmap roadmap{core::PlanningOptions{}};
  Session session{1, "test"};
  const karst_host_t* h = session.host();
  karst_error_t e{};

  void SetUp() override {
    session.set_decision_thread(std::this_thread::get_id());
    core::DecisionRequest request;
    request.map = &map;
    request.roadmap = &roadmap;
    session.begin_deciding(request);
  }
};

TEST_F(Asked, NullArraysAreRefused) {
  EXPECT_EQ(h->map->cell_states(h, session.live_map(), nullptr, 1, nullptr, &e), KARST_ERROR_ARGUMENT);
  EXPECT_STREQ(e.text, "an array is NULL");
  EXPECT_EQ(h->map->cell_states(h, session.live_map(), nullptr, 0, nullptr, nullptr), KARST_OK)
      << "nothing asked";
  EXPECT_EQ(h->map->info(h, session.live_map(), nullptr, nullptr), KARST_ERROR_ARGUMENT);
}

TEST_F(Asked, TooLargeBatchesAreRefusedBeforeAnythingIsRead) {
  karst_vec3_t p{};
  karst_cell_t c{};
  EXPECT_EQ(h->map->cell_states(h, session.live_map(), &p, KARST_MAX_BATCH + 1, &c, &e), KARST_ERROR_LIMIT);
  double length = 0;
  EXPECT_EQ(h->path->lengths(h, p, &p, KARST_MAX_PATH_GOALS + 1, 0.5, &length, &e), KARST_ERROR_LIMIT);
}

TEST_F(Asked, WhatIsNotFiniteIsRefused) {
  const karst_vec3_t p{NAN, 0, 0};
  karst_cell_t c{};
  EXPECT_EQ(h->map->cell_states(h, session.live_map(), &p, 1, &c, &e), KARST_ERROR_ARGUMENT);
  const karst_box_t inside_out{{1, 0, 0}, {0, 1, 1}};
  karst_cell_counts_t counts{};
  EXPECT_EQ(h->map->count_in_boxes(h, session.live_map(), &inside_out, 1, &counts, &e), KARST_ERROR_ARGUMENT);
  const karst_segment_t too_long{{0, 0, 0}, {1001, 0, 0}};
  karst_ray_end_t end{};
  EXPECT_EQ(h->map->cast_rays(h, session.live_map(), &too_long, 1, 0, &end, &e), KARST_ERROR_ARGUMENT);
  EXPECT_EQ(h->draw->points(h, &p, 1, 0, &e), KARST_ERROR_ARGUMENT);
}

TEST_F(Asked, BoxAsLargeAsTheWorldIsCountedInNoTime) {
  const karst_box_t world{{-1e5, -1e5, -1e5}, {1e5, 1e5, 1e5}};
  karst_cell_counts_t counts{};
  EXPECT_EQ(h->map->count_in_boxes(h, session.live_map(), &world, 1, &counts, &e), KARST_OK);
  EXPECT_EQ(counts.free + counts.occupied, 0u);
  EXPECT_GT(counts.unknown, 1000000u);
}

TEST_F(Asked, BoxOfMoreCellsThanCanBeCountedIsRefused) {
  const karst_box_t box{{-1e300, -1e300, -1e300}, {1e300, 1e300, 1e300}};
  karst_cell_counts_t counts{};
  EXPECT_EQ(h->map->count_in_boxes(h, session.live_map(), &box, 1, &counts, &e), KARST_ERROR_LIMIT);
  EXPECT_STREQ(e.text, "a box holds 2^63 cells or more");
  std::uint64_t total = 1;
  EXPECT_EQ(h->map->surface_cells(h, session.live_map(), box, nullptr, 0, &total, &e), KARST_OK);
  EXPECT_EQ(total, 0u);
}

TEST_F(Asked, DistancesToRockBeyondTheirLimitsAreRefused) {
  const karst_vec3_t p{}, nowhere{NAN, 0, 0}, far{2e5, 0, 0};
  double out = -1;
  const auto ask = [&](const karst_vec3_t& point, double limit_m) {
    return h->map->distances_to_rock(h, session.live_map(), &point, 1, limit_m, &out, &e);
  };
  EXPECT_EQ(ask(p, 2), KARST_OK);
  EXPECT_EQ(out, 2) << "nothing is known";
  EXPECT_EQ(ask(p, 0), KARST_ERROR_ARGUMENT);
  EXPECT_EQ(ask(p, NAN), KARST_ERROR_ARGUMENT);
  EXPECT_EQ(ask(p, 100.5), KARST_ERROR_ARGUMENT);
  EXPECT_EQ(ask(nowhere, 2), KARST_ERROR_ARGUMENT);
  EXPECT_EQ(ask(far, 2), KARST_ERROR_ARGUMENT);
  EXPECT_EQ(ask(p, 100), KARST_ERROR_LIMIT) << "a thousand cells in each axis";
  const std::vector<karst_vec3_t> many(4000);
  std::vector<double> distances(many.size());
  EXPECT_EQ(
      h->map->distances_to_rock(h, session.live_map(), many.data(), many.size(), 3, distances.data(), &e),
      KARST_ERROR_LIMIT);
  EXPECT_NE(std::string(e.text).find("fewer at a time"), std::string::npos) << e.text;
}

TEST_F(Asked, PassagesWithoutAPlaceForThemAreRefused) {
  std::uint64_t passages = 7, ends = 7;
  const karst_map_t* m = session.live_map();
  EXPECT_EQ(h->map->passages(h, m, nullptr, 0, nullptr, nullptr, 0, &ends, &e), KARST_ERROR_ARGUMENT);
  EXPECT_STREQ(e.text, "a total is NULL");
  EXPECT_EQ(h->map->passages(h, m, nullptr, 0, &passages, nullptr, 0, nullptr, &e), KARST_ERROR_ARGUMENT);
  EXPECT_EQ(h->map->passages(h, m, nullptr, 1, &passages, nullptr, 0, &ends, &e), KARST_ERROR_ARGUMENT);
  EXPECT_STREQ(e.text, "an array is NULL");
  EXPECT_EQ(h->map->passages(h, m, nullptr, 0, &passages, nullptr, 1, &ends, nullptr), KARST_ERROR_ARGUMENT);
  EXPECT_EQ(h->map->passages(h, m, nullptr, 0, &passages, nullptr, 0, &ends, &e), KARST_OK);
  EXPECT_EQ(passages + ends, 0u) << "nothing is known";
  EXPECT_EQ(h->map->passages(h, nullptr, nullptr, 0, &passages, nullptr, 0, &ends, &e), KARST_ERROR_STATE);

  const karst_vec3_t p{}, nowhere{NAN, 0, 0}, far{1e300, 0, 0};
  karst_passage_place_t place{};
  EXPECT_EQ(h->map->passages_at(h, m, nullptr, 1, &place, &e), KARST_ERROR_ARGUMENT);
  EXPECT_EQ(h->map->passages_at(h, m, &p, 1, nullptr, &e), KARST_ERROR_ARGUMENT);
  EXPECT_EQ(h->map->passages_at(h, m, &p, KARST_MAX_BATCH + 1, &place, &e), KARST_ERROR_LIMIT);
  EXPECT_EQ(h->map->passages_at(h, m, &nowhere, 1, &place, &e), KARST_ERROR_ARGUMENT);
  EXPECT_EQ(h->map->passages_at(h, m, &far, 1, &place, &e), KARST_OK);
  EXPECT_EQ(place.passage, KARST_NO_PASSAGE);
  EXPECT_EQ(place.end, KARST_NO_PASSAGE);
  session.end_deciding();
  EXPECT_EQ(h->map->passages(h, m, nullptr, 0, &passages, nullptr, 0, &ends, &e), KARST_ERROR_STATE);
}

TEST_F(Asked, PassagesOfATooLargeMapAreRefusedEveryTime) {
  core::VoxelMap large{core::MapOptions{.resolution_m = 1.0}};
  large.assign({0, 0, 0}, 95, -2.0f);  // each of its 857,375 cells is 61 steps of work
  core::DecisionRequest request;
  request.map = &large;
  session.begin_deciding(request);
  std::uint64_t passages = 0, ends = 0;
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(h->map->passages(h, session.live_map(), nullptr, 0, &passages, nullptr, 0, &ends, &e),
              KARST_ERROR_LIMIT);
    EXPECT_NE(std::string(e.text).find("the map is too large"), std::string::npos) << e.text;
  }
}

TEST_F(Asked, SensorFarFromTheBodyOrOfTooLongRangeForTheMapIsRefused) {
  const core::VoxelMap fine{core::MapOptions{.resolution_m = 0.05}};
  core::DecisionRequest request;
  request.map = &fine;
  session.begin_deciding(request);
  karst_sensor_t s{};
  s.kind = KARST_SENSOR_LIDAR;
  s.T_body_sensor.orientation.w = 1;
  s.max_range_m = 60;
  s.horizontal_fov_rad = 6;
  const karst_viewpoint_t from{};
  std::uint64_t seen = 0;
  const auto ask = [&] { return h->gain->newly_seen(h, session.live_map(), &s, 1, &from, 1, &seen, &e); };
  EXPECT_EQ(ask(), KARST_ERROR_LIMIT);
  EXPECT_STREQ(e.text, "sensor 0: max_range_m is more than 300 cells of the map");
  s.max_range_m = 2;
  EXPECT_EQ(ask(), KARST_OK);
  s.T_body_sensor.position.x = 1e300;
  EXPECT_EQ(ask(), KARST_ERROR_ARGUMENT);
}

TEST_F(Asked, MapOfTheRequestEndsWithItAndARetainedOneDoesNot) {
  const karst_map_t* kept = h->map->retain(h, session.live_map(), &e);
  ASSERT_NE(kept, nullptr);
  session.end_deciding();
  karst_map_info_t info{};
  EXPECT_EQ(h->map->info(h, session.live_map(), &info, &e), KARST_ERROR_STATE);
  EXPECT_EQ(h->map->info(h, kept, &info, &e), KARST_OK);
  h->map->release(h, kept);
  EXPECT_EQ(h->map->info(h, kept, &info, &e), KARST_ERROR_STATE);
  h->map->release(h, kept);  // twice: nothing happens
  const karst_vec3_t p{};
  double length = 0;
  EXPECT_EQ(h->path->lengths(h, p, &p, 1, 0.5, &length, &e), KARST_ERROR_STATE);
}

TEST_F(Asked, ForeignHandleIsNoMap) {
  karst_map_info_t info{};
  const auto* nonsense = reinterpret_cast<const karst_map_t*>(std::uintptr_t{0x1234});
  EXPECT_EQ(h->map->info(h, nonsense, &info, &e), KARST_ERROR_STATE);
  EXPECT_EQ(h->map->info(h, nullptr, &info, &e), KARST_ERROR_STATE);
}

TEST_F(Asked, SlotsForTheDecisionThreadAreForItOnly) {
  std::int32_t drawn = 0, asked = -1;
  std::thread([&] {
    karst_error_t error{};
    const karst_vec3_t p{};
    drawn = h->draw->points(h, &p, 1, 0, &error);
    karst_map_info_t info{};
    asked = h->map->info(h, session.live_map(), &info, &error);
  }).join();
  EXPECT_EQ(drawn, KARST_ERROR_THREAD);
  EXPECT_EQ(asked, KARST_OK) << "this one is for any thread";
}

TEST_F(Asked, AfterTheHostGaveUpEverythingFailsAndTheStopSignIsUp) {
  EXPECT_EQ(h->should_stop(h), 0u);
  session.abandon();
  EXPECT_NE(h->should_stop(h), 0u);
  karst_map_info_t info{};
  EXPECT_EQ(h->map->info(h, session.live_map(), &info, &e), KARST_ERROR_ABANDONED);
  double chance[3] = {-1, -1, -1};
  h->random(h, chance, 3);
  EXPECT_EQ(chance[2], 0.5);
}

TEST_F(Asked, LogAndDrawingsAreBounded) {
  for (int i = 0; i < 10000; ++i) h->log(h, KARST_LOG_WARNING, {"again\nand again", 15});
  const std::vector<std::string> lines = session.take_log();
  EXPECT_EQ(lines.size(), 200u);
  EXPECT_EQ(lines.front(), "warning: again and again");
  EXPECT_EQ(lines.back(), "(more lines were dropped)");
  const std::vector<karst_vec3_t> many(200'000);
  EXPECT_EQ(h->draw->points(h, many.data(), many.size(), 0, &e), KARST_OK);
  EXPECT_EQ(h->draw->points(h, many.data(), 1, 0, &e), KARST_ERROR_LIMIT);
  EXPECT_EQ(session.take_drawings().size(), 1u);
  EXPECT_EQ(h->draw->points(h, many.data(), 1, 0, &e), KARST_OK) << "a new decision";
}

}  // namespace
}  // namespace karst::host
