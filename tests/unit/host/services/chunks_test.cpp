// Questions and answers larger than the host takes at once, from a policy in C++.
#include <karst/chunks.h>

#include <gtest/gtest.h>

#include <karst/imaged.h>
#include <karst/policy.h>

#include <thread>

#include "sdk/host/boundary/decision_box.h"
#include "sdk/host/services/session.h"

namespace karst::host {
namespace {

/// A cell of rock at the origin, with free cells around it and far to the west. The path to a goal is as long
/// as its x.
struct LargeQuestions : ::testing::Test {
  core::VoxelMap map{core::MapOptions{}};
  core::VehicleDescription vehicle;
  core::ImagedSurface imaged;
  core::DecisionRequest request;
  Session session{1, "test"};
  const karst_host_t* h = session.host();
  std::vector<std::size_t> path_calls;

  void SetUp() override {
    for (int x = -8; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) map.assign({x, y, z}, 1, x == 0 && y == 0 && z == 0 ? 2.0f : -2.0f);
    auto rgb = std::make_shared<core::RgbCameraModel>();
    rgb->camera.width = 32, rgb->camera.height = 24;
    rgb->camera.horizontal_fov_rad = 1.4, rgb->camera.vertical_fov_rad = 1.1;
    rgb->camera.max_range_m = 2;
    vehicle.rgb = rgb;
    request.map = &map;
    request.vehicle = &vehicle;
    request.imaged = &imaged;
    session.set_decision_thread(std::this_thread::get_id());
    session.begin_deciding(request, [this](const core::Vec3&, std::span<const core::Vec3> goals, double) {
      path_calls.push_back(goals.size());
      PathAnswer answer{PathAnswer::Status::answered, {}};
      for (const core::Vec3& goal : goals) answer.lengths_m.push_back(goal.x());
      return answer;
    });
  }
  karst::Request view() const {
    karst_request_t r{};
    r.size = sizeof r;
    r.map = session.live_map();
    return {h, r};
  }
};

TEST_F(LargeQuestions, OfTheMapAreAnswered) {
  const karst::MapView cells = view().map;
  const std::size_t count = KARST_MAX_BATCH + 1;
  std::vector<karst::Vec3> points(count, karst::Vec3(0.3, 0.1, 0.1));  // the map's cells are 0.2 m
  points.back() = {0.1, 0.1, 0.1};
  const std::vector<karst::Cell> states = cells.cells(points);
  ASSERT_EQ(states.size(), count);
  EXPECT_EQ(states[count - 2], karst::Cell::free);
  EXPECT_EQ(states[count - 1], karst::Cell::occupied);

  std::vector<karst_segment_t> rays(count, karst_segment_t{{0.3, 0.1, 0.1}, {0.3, 0.3, 0.1}});
  rays.back().to = {-0.1, 0.1, 0.1};
  const std::vector<karst_ray_end_t> ends = cells.cast(rays, false);
  EXPECT_EQ(ends[count - 2].state, karst_cell_t{KARST_CELL_FREE});
  EXPECT_EQ(ends[count - 1].state, karst_cell_t{KARST_CELL_OCCUPIED});

  std::vector<karst::Box> boxes(count, karst::Box{{0.25, 0.05, 0.05}, {0.35, 0.15, 0.15}});
  boxes.back() = {{-1, -1, -1}, {1, 1, 1}};
  const std::vector<karst_cell_counts_t> counts = cells.counts(boxes);
  EXPECT_EQ(counts[count - 2].free, 1u);
  EXPECT_EQ(counts[count - 1].free, 62u) << "7 x 3 x 3 cells but for the rock";
}

TEST_F(LargeQuestions, OfPathsAreAnsweredByOneSearchForEveryFullCall) {
  std::vector<karst::Vec3> goals(KARST_MAX_PATH_GOALS + 3);
  for (std::size_t i = 0; i < goals.size(); ++i) goals[i].x = static_cast<double>(i);
  const std::vector<double> lengths = view().path_lengths({0, 0, 0}, goals, 0.5);
  ASSERT_EQ(lengths.size(), goals.size());
  for (std::size_t i = 0; i < lengths.size(); ++i) ASSERT_EQ(lengths[i], static_cast<double>(i));
  EXPECT_EQ(path_calls, (std::vector<std::size_t>{KARST_MAX_PATH_GOALS, 3}));
}

TEST_F(LargeQuestions, OfViewsAndPicturesAreAnswered) {
  const std::size_t count = KARST_MAX_GAIN_VIEWPOINTS + 1;
  std::vector<karst::Viewpoint> from(count, karst::Viewpoint{{50, 0, 0}, 0});  // unknown space all around
  from.back() = {{-1, 0.1, 0.1}, 0};                                           // the rock is 1 m ahead
  karst::Sensor lidar{};
  lidar.kind = KARST_SENSOR_LIDAR;
  lidar.T_body_sensor.orientation.w = 1;
  lidar.max_range_m = 0.5;
  lidar.horizontal_fov_rad = 6.28;
  lidar.low_elevation_rad = -0.5, lidar.high_elevation_rad = 0.5;
  const std::vector<std::uint64_t> seen = view().newly_seen(lidar, from);
  ASSERT_EQ(seen.size(), count);
  EXPECT_EQ(seen[count - 2], seen[0]);
  EXPECT_LT(seen[count - 1], seen[0]) << "some of what is around is known there";

  const auto pictures = karst::ImagedView::of(h);
  ASSERT_TRUE(pictures);
  const std::vector<std::uint64_t> counts = pictures->newly_imaged(from);
  const std::vector<std::vector<karst::Vec3>> cells = pictures->newly_imaged_cells(from);
  ASSERT_EQ(counts.size(), count);
  ASSERT_EQ(cells.size(), count);
  EXPECT_EQ(counts[count - 2], 0u);
  EXPECT_TRUE(cells[count - 2].empty());
  EXPECT_EQ(cells[count - 1].size(), counts[count - 1]);
  EXPECT_EQ(counts[count - 1], 1u);

  std::vector<karst::Vec3> points(KARST_MAX_BATCH + 1, karst::Vec3(0.3, 0.1, 0.1));
  points.back() = {0.1, 0.1, 0.1};
  const std::vector<karst_imaged_t> states = pictures->states(points);
  EXPECT_EQ(states.front(), karst_imaged_t{KARST_IMAGED_NO_SURFACE});
  EXPECT_EQ(states.back(), karst_imaged_t{KARST_IMAGED_NOT});
}

/// More goals than the host takes, with longer reasons.
class Verbose : public karst::Policy {
  karst::Decision decide(const karst::Request&) override {
    std::vector<karst::Goal> goals(kMaxGoals + 1);
    for (karst::Goal& g : goals) g.why = std::string(239, 'x') + "\u00e9";
    return karst::Decision::fly(goals);
  }
};

TEST_F(LargeQuestions, OfGoalsTheFirstAreAcceptedAndTheLogSaysSo) {
  const karst_policy_t* policy = border::entry<Verbose>("verbose", "1.0.0", "Says much.");
  ASSERT_NE(policy, nullptr);
  karst_error_t e{};
  void* self = policy->create(h, &e);
  ASSERT_NE(self, nullptr) << e.text;
  ASSERT_EQ(policy->init(self, nullptr, 0, &e), KARST_OK);
  karst_request_t r{};
  r.size = sizeof r;
  r.map = session.live_map();
  DecisionBox box;
  const karst_decision_sink_t sink = box.sink();
  EXPECT_EQ(policy->decide(self, &r, &sink, &e), KARST_OK) << e.text;
  policy->destroy(self);
  EXPECT_EQ(box.fault(), "");
  EXPECT_TRUE(box.refused().empty());
  EXPECT_EQ(box.decision().goals.size(), kMaxGoals);
  EXPECT_EQ(box.decision().goals.front().why, std::string(239, 'x'));
  EXPECT_EQ(session.take_log(),
            (std::vector<std::string>{"of 65 goals only the first 64 are offered: the host takes no more",
                                      "64 texts are cut to 240 bytes: the host takes no longer lines"}));
}

}  // namespace
}  // namespace karst::host
