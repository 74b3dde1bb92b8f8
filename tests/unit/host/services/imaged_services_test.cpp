// The extension "karst.imaged/1", asked as a policy in C++ asks it.
#include <gtest/gtest.h>

#include <karst/imaged.h>

#include <cmath>
#include <thread>

#include "sdk/host/services/session.h"
#include "sdk/host/services/translation.h"

namespace karst::host {
namespace {

/// Free space before a wall at x = 4 m; a camera that looks east, and has taken one picture from (1, 0, 0).
struct Pictures : ::testing::Test {
  core::VoxelMap map{core::MapOptions{}};
  core::VehicleDescription vehicle;
  core::ImagedSurface imaged;
  core::DecisionRequest request;
  Session session{1, "test"};
  const karst_host_t* h = session.host();

  void SetUp() override {
    for (int y = -40; y < 40; ++y)
      for (int z = -20; z < 20; ++z) {
        for (int x = -2; x < 20; ++x) map.assign({x, y, z}, 1, -2.0f);
        map.assign({20, y, z}, 1, 2.0f);
      }
    auto rgb = std::make_shared<core::RgbCameraModel>();
    rgb->camera.name = "rgb";
    rgb->camera.width = 320, rgb->camera.height = 240;
    rgb->camera.horizontal_fov_rad = 1.4, rgb->camera.vertical_fov_rad = 1.1;
    rgb->camera.max_range_m = 6;
    rgb->camera.period = core::kSecond / 2;
    vehicle.rgb = rgb;
    imaged.take(map, {{1, 0.05, 0.05}, core::Quat::Identity()}, *rgb);
    request.map = &map;
    request.vehicle = &vehicle;
    request.imaged = &imaged;
    session.set_decision_thread(std::this_thread::get_id());
  }
  const karst_imaged_service_t* service() const {
    const std::string id = KARST_IMAGED_ID;
    return static_cast<const karst_imaged_service_t*>(h->extension(h, karst::to_abi(id)));
  }
};

TEST_F(Pictures, AnswersAreTheCores) {
  session.begin_deciding(request);
  const auto view = karst::ImagedView::of(h);
  ASSERT_TRUE(view);
  EXPECT_EQ(view->camera().sensor.kind, static_cast<karst_sensor_kind_t>(KARST_SENSOR_RGB));
  EXPECT_EQ(karst::from_abi(view->camera().sensor.name), "rgb");
  EXPECT_DOUBLE_EQ(view->camera().period_s, 0.5);
  EXPECT_EQ(view->states({{4.1, 0, 0}, {4.1, 6, 0}, {2, 0, 0}, {9, 0, 0}}),
            (std::vector<karst_imaged_t>{KARST_IMAGED_YES, KARST_IMAGED_NOT, KARST_IMAGED_NO_SURFACE,
                                         KARST_IMAGED_NO_SURFACE}));
  const core::UnimagedSurface unimaged(map, imaged);
  const auto all = view->unimaged({{-100, -100, -100}, {100, 100, 100}});
  ASSERT_EQ(all.size(), unimaged.cells().size());
  for (std::size_t i = 0; i < all.size(); ++i)
    EXPECT_EQ(to_core(all[i].center), map.center_of(unimaged.cells()[i].key));
  EXPECT_NEAR(all[0].normal.x, -1, 0.35);
  const auto some = view->unimaged({{4, 5, -1}, {4.2, 7, 1}});
  EXPECT_EQ(some.size(), 100u) << "2 m by 2 m of wall that no picture shows";

  const std::vector<karst::Viewpoint> from = {{{1, 4, 0}, 0}, {{1, 0.05, 0.05}, 0}, {{1, 4, 0}, 3.1}};
  const auto counts = view->newly_imaged(from);
  const auto cells = view->newly_imaged_cells(from);
  ASSERT_EQ(cells.size(), 3u);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const core::Pose T{to_core(from[i].position), core::from_heading(from[i].heading_rad)};
    const auto expected = unimaged.seen_from(T, *vehicle.rgb);
    EXPECT_EQ(counts[i], expected.size());
    ASSERT_EQ(cells[i].size(), expected.size());
    for (std::size_t j = 0; j < expected.size(); ++j)
      EXPECT_EQ(to_core(cells[i][j]), map.center_of(unimaged.cells()[expected[j]].key));
  }
  EXPECT_GT(counts[0], 100u);
  EXPECT_EQ(counts[1], 0u) << "it was there";
  EXPECT_EQ(counts[2], 0u) << "it would look away";
}

TEST_F(Pictures, WithoutACameraTheViewIsEmptyAndNobodyFails) {
  vehicle.rgb.reset();
  request.imaged = nullptr;
  session.begin_deciding(request);
  EXPECT_FALSE(karst::ImagedView::of(h));
  karst_error_t e{};
  std::uint64_t total = 0;
  EXPECT_EQ(service()->unimaged(h, {{0, 0, 0}, {1, 1, 1}}, nullptr, 0, &total, &e), KARST_ERROR_UNAVAILABLE);
}

TEST_F(Pictures, OutsideOfADecisionOrOnAnotherThreadNothingIsSaid) {
  karst_imaged_camera_t camera{};
  karst_error_t e{};
  EXPECT_EQ(service()->camera(h, &camera, &e), KARST_ERROR_STATE);
  session.begin_deciding(request);
  EXPECT_EQ(service()->camera(h, &camera, &e), KARST_OK);
  std::thread([&] { EXPECT_EQ(service()->camera(h, &camera, &e), KARST_ERROR_THREAD); }).join();
  session.end_deciding();
  EXPECT_EQ(service()->camera(h, &camera, &e), KARST_ERROR_STATE);
}

TEST_F(Pictures, BadArgumentsAreRefused) {
  session.begin_deciding(request);
  karst_error_t e{};
  EXPECT_EQ(service()->camera(h, nullptr, &e), KARST_ERROR_ARGUMENT);
  const karst_viewpoint_t nowhere{{NAN, 0, 0}, 0};
  std::uint64_t n = 0;
  EXPECT_EQ(service()->newly_imaged(h, &nowhere, 1, &n, &e), KARST_ERROR_ARGUMENT);
  EXPECT_EQ(service()->newly_imaged(h, nullptr, 1, &n, &e), KARST_ERROR_ARGUMENT);
  EXPECT_EQ(service()->newly_imaged(h, &nowhere, KARST_MAX_GAIN_VIEWPOINTS + 1, &n, &e), KARST_ERROR_LIMIT);
  EXPECT_EQ(service()->unimaged(h, {{1, 0, 0}, {0, 1, 1}}, nullptr, 0, &n, &e), KARST_ERROR_ARGUMENT);
  EXPECT_EQ(h->extension(h, {"karst.imaged/2", 14}), nullptr);
  EXPECT_EQ(h->extension(h, {nullptr, 0}), nullptr);
}

TEST_F(Pictures, TheCameraStandsAmongTheSensors) {
  const RequestPack pack(request, session.live_map());
  ASSERT_EQ(pack.request().sensor_count, 1u);
  const karst_sensor_t& s = pack.request().sensors[0];
  EXPECT_EQ(s.kind, static_cast<karst_sensor_kind_t>(KARST_SENSOR_RGB));
  EXPECT_DOUBLE_EQ(s.max_range_m, 6);
  EXPECT_DOUBLE_EQ(s.high_elevation_rad, 0.55);
}

}  // namespace
}  // namespace karst::host
