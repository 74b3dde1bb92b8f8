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

}  // namespace
}  // namespace karst::host
