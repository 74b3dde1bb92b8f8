#include "sdk/host/services/path_question.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sdk/host/services/session.h"

namespace karst::host {
namespace {

/// A hall of 32 x 32 x 4 m, and sealed pockets of one free cell in the rock beside it: no place sees into
/// them, however far around is looked.
struct Hall {
  core::VoxelMap map{core::MapOptions{}};
  core::Roadmap roadmap{core::PlanningOptions{}};
  std::vector<core::Vec3> pockets;

  Hall() {
    constexpr float free = -2.0f, rock = 2.0f;
    for (int x = -6; x <= 160; ++x)
      for (int y = -1; y <= 160; ++y)
        for (int z = -1; z <= 20; ++z) {
          const bool inside = x >= 0 && x < 160 && y >= 0 && y < 160 && z >= 0 && z < 20;
          const bool pocket = x == -3 && y % 3 == 1 && z % 3 == 1;
          map.assign({x, y, z}, 1, inside || pocket ? free : rock);
          if (pocket) pockets.push_back(map.center_of({x, y, z}));
        }
    std::vector<core::CellChange> changes;
    map.for_each_known([&](const core::CellKey& k, core::Cell c, float) {
      changes.push_back({k, core::Cell::unknown, c});
    });
    roadmap.update(map, changes);
  }
  PathAnswer ask(std::size_t goals, double tolerance_m) const {
    return path_lengths(map, roadmap, {3, 3, 2}, std::span(pockets).first(goals), tolerance_m);
  }
};

TEST(PathQuestion, OfGoalsThatNothingSeesIsAnsweredOrRefusedByTheWorkItIs) {
  const Hall hall;
  ASSERT_GT(hall.pockets.size(), 300u);
  const PathAnswer one = hall.ask(1, 100), near = hall.ask(300, 1.5), far = hall.ask(300, 100);
  ASSERT_EQ(one.status, PathAnswer::Status::answered);
  EXPECT_TRUE(std::isinf(one.lengths_m.at(0)));
  EXPECT_EQ(near.status, PathAnswer::Status::answered);
  EXPECT_EQ(far.status, PathAnswer::Status::too_much);
  EXPECT_TRUE(far.lengths_m.empty());
}

TEST(PathQuestion, ThatIsTooMuchIsRefusedAndTheNextAnswered) {
  const Hall hall;
  Session session{1, "test"};
  session.set_decision_thread(std::this_thread::get_id());
  core::DecisionRequest request;
  request.map = &hall.map;
  request.roadmap = &hall.roadmap;
  session.begin_deciding(request);
  const karst_host_t* const h = session.host();
  std::vector<karst_vec3_t> goals;
  for (const core::Vec3& p : hall.pockets) goals.push_back(to_abi(p));
  std::vector<double> out(goals.size());
  karst_error_t e{};
  EXPECT_EQ(h->path->lengths(h, {3, 3, 2}, goals.data(), 300, 100, out.data(), &e), KARST_ERROR_LIMIT);
  EXPECT_NE(std::string(e.text).find("fewer at a time"), std::string::npos) << e.text;
  const karst_vec3_t clear{20, 20, 2};
  EXPECT_EQ(h->path->lengths(h, {3, 3, 2}, &clear, 1, 100, out.data(), &e), KARST_OK);
  EXPECT_NEAR(out[0], std::hypot(17, 17), 0.15 * std::hypot(17, 17));
}

TEST(Paths, LeadThroughTheHallWithLengthClearanceAndPoints) {
  const Hall hall;
  const std::vector<core::Vec3> goals = {{20, 20, 2}, {6, 3, 2}, hall.pockets.front(), {3, 3, 2}};
  const PathsAnswer answer = find_paths(hall.map, hall.roadmap, {3, 3, 2}, goals, 0.5);
  ASSERT_EQ(answer.status, PathAnswer::Status::answered);
  ASSERT_EQ(answer.paths.size(), 4u);
  const FoundPath& far = answer.paths[0];
  ASSERT_GE(far.points.size(), 2u);
  EXPECT_EQ(far.points.front(), core::Vec3(3, 3, 2));
  EXPECT_EQ(far.points.back(), core::Vec3(20, 20, 2));
  EXPECT_NEAR(far.length_m, core::path_length_m(far.points), 1e-9);
  EXPECT_GE(far.length_m, std::hypot(17, 17) - 1e-9);
  EXPECT_LE(far.length_m, 1.2 * std::hypot(17, 17));
  EXPECT_GE(far.clearance_m, 0.5);
  EXPECT_LE(far.clearance_m, 2.14) << "the floor is 2 m below, and the centres of its cells 0.1 m lower";
  EXPECT_EQ(answer.paths[1].points, (std::vector<core::Vec3>{{3, 3, 2}, {6, 3, 2}}))
      << "near: a straight line";
  EXPECT_DOUBLE_EQ(answer.paths[1].length_m, 3);
  EXPECT_NEAR(answer.paths[1].clearance_m, std::hypot(2.1, 0.1), 0.025) << "to an eighth of a cell";
  EXPECT_TRUE(answer.paths[2].points.empty()) << "nothing leads into a pocket";
  EXPECT_TRUE(std::isinf(answer.paths[2].length_m));
  EXPECT_EQ(answer.paths[2].clearance_m, 0);
  EXPECT_EQ(answer.paths[3].length_m, 0) << "it is there";
}

TEST(Paths, BeyondTheLimitsAreRefused) {
  const Hall hall;
  const std::vector<core::Vec3> many(KARST_MAX_PATHS + 1, core::Vec3(6, 3, 2));
  const auto status = [&](std::size_t count) {
    return find_paths(hall.map, hall.roadmap, {3, 3, 2}, std::span(many).first(count), 0.5).status;
  };
  EXPECT_EQ(status(KARST_MAX_PATHS), PathAnswer::Status::answered);
  EXPECT_EQ(status(KARST_MAX_PATHS + 1), PathAnswer::Status::too_much);
  const auto pockets = std::span(hall.pockets).first(KARST_MAX_PATHS);
  EXPECT_EQ(find_paths(hall.map, hall.roadmap, {3, 3, 2}, pockets, 100).status, PathAnswer::Status::too_much);
}

TEST(Paths, ComeThroughTheServiceAsManyPointsAsThereIsRoomFor) {
  const Hall hall;
  Session session{1, "test"};
  session.set_decision_thread(std::this_thread::get_id());
  core::DecisionRequest request;
  request.map = &hall.map;
  request.roadmap = &hall.roadmap;
  request.max_speed_mps = 2;
  request.max_acceleration_mps2 = 2;
  session.begin_deciding(request);
  const karst_host_t* const h = session.host();
  const std::vector<karst_vec3_t> goals = {{6, 3, 2}, {3, 6, 2}};
  std::vector<karst_path_t> out(2);
  std::vector<karst_vec3_t> points(3, karst_vec3_t{-1, -1, -1});
  karst_error_t e{};
  ASSERT_EQ(h->path->paths(h, {3, 3, 2}, goals.data(), 2, 0.5, out.data(), points.data(), 2, &e), KARST_OK);
  EXPECT_EQ(out[0].points_end, 2u);
  EXPECT_EQ(out[1].points_end, 4u) << "all, though there was no room for them";
  EXPECT_EQ(points[1].x, 6);
  EXPECT_EQ(points[2].x, -1) << "beyond the capacity";
  EXPECT_DOUBLE_EQ(out[0].length_m, 3);
  EXPECT_DOUBLE_EQ(out[0].time_s, 3 / 1.6 + 1.6 / 2) << "cruising at 0.8 of 2 m/s";
  EXPECT_EQ(h->path->paths(h, {3, 3, 2}, goals.data(), 2, 0.5, out.data(), nullptr, 1, &e),
            KARST_ERROR_ARGUMENT);
  EXPECT_EQ(h->path->paths(h, {3, 3, 2}, goals.data(), 2, -1, out.data(), nullptr, 0, &e),
            KARST_ERROR_ARGUMENT);
  EXPECT_EQ(h->path->paths(h, {3, 3, 2}, goals.data(), KARST_MAX_PATHS + 1, 0.5, out.data(), nullptr, 0, &e),
            KARST_ERROR_LIMIT);
  session.end_deciding();
  EXPECT_EQ(h->path->paths(h, {3, 3, 2}, goals.data(), 2, 0.5, out.data(), nullptr, 0, &e),
            KARST_ERROR_STATE);
}

}  // namespace
}  // namespace karst::host
