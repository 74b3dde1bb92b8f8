#include "core_stack/mission/sensor_pipeline.h"

#include "tests/unit/mission/onboard_fixture.h"

namespace karst::core {
namespace {

class SensorPipelineTest : public OnboardTest {
 protected:
  /// A scan of a sphere of that radius around the vehicle.
  std::shared_ptr<const LidarScan> scan(TimeNs stamp, float range_m = 3) const {
    auto s = std::make_shared<LidarScan>();
    s->stamp = stamp;
    s->model = onboard.vehicle.lidar;
    const std::size_t beams = s->model->elevation_rad.size() * static_cast<std::size_t>(s->model->columns);
    s->range_m.assign(beams, range_m);
    s->intensity.assign(beams, 0.5f);
    return s;
  }
  MapQuestion question;
  std::vector<MapNews> news;
  std::vector<MovingBody> others;
  bool look_for_others = false;
  SensorPipeline sensors{onboard,
                         {.ask = [this] { return question; },
                          .tell = [this](const MapNews& n) { news.push_back(n); },
                          .others = [this](TimeNs) { return others; },
                          .look_for_others = [this] { return look_for_others; }}};
};

TEST_F(SensorPipelineTest, AScanIsInTheMapWhenItsBudgetIsOver) {
  advance(1);
  sensors.on_lidar(scan(now()));
  EXPECT_TRUE(news.empty());
  EXPECT_EQ(sensors.blind_for(), now());
  advance(seconds(kMappingBudget) + 0.01);
  ASSERT_EQ(news.size(), 1u);
  EXPECT_FALSE(news[0].changes.empty());
  EXPECT_GT(sensors.explored_m3(), 0);
  EXPECT_LT(sensors.blind_for(), 2 * kMappingBudget);
}

TEST_F(SensorPipelineTest, AScanOfTheFutureAndWhateverComesAfterTheEndAreNotMapped) {
  advance(1);
  sensors.on_lidar(scan(now() + 1));
  advance(0.2);
  EXPECT_TRUE(news.empty());
  sensors.close();
  sensors.on_lidar(scan(now()));
  advance(0.2);
  EXPECT_TRUE(news.empty());
}

TEST_F(SensorPipelineTest, ScansOfAClockThatWasSetBackAreMappedAsOfWhenTheyWereTaken) {
  const auto fly = [this](double until_s, TimeNs off) {
    while (now() < from_seconds(until_s)) {
      advance(0.1);
      sensors.on_lidar(scan(now() + off));
    }
    advance(0.1);
  };
  fly(2, 0);
  const std::size_t before = news.size();
  fly(4, -250 * kMillisecond);
  EXPECT_EQ(news.size(), before + 18) << "all but the first";
  EXPECT_EQ(told("the LiDAR's clock was set"), 1u);
  EXPECT_EQ(told("\"correction\":0.25"), 1u);
  fly(6, 0);
  EXPECT_EQ(told("the LiDAR's clock is right again"), 1u);
}

TEST_F(SensorPipelineTest, APoseSensorLocatesTheVehicleOnlyWhereNoLidarDoes) {
  PoseSample pose;
  pose.T_world_body.position = {0.5, 0, 0};
  const auto feed = [&](SensorPipeline& to) {
    for (int i = 0; i < 300; ++i) {
      executive.run_until(now() + 10 * kMillisecond, [] { return false; });
      onboard.flight.on_imu({now(), Vec3(0, 0, 9.81), Vec3::Zero()}, now());
      pose.stamp = now();
      to.on_pose(pose);
    }
    return onboard.flight.state().position.x();
  };
  Onboard by_lidar{CoreOptions{}, with_lidar(), executive, recorder, policy};
  SensorPipeline located_by_lidar{by_lidar, {}};
  feed(located_by_lidar);
  EXPECT_EQ(by_lidar.flight.state().position.x(), 0) << "its poses are not taken";
  EXPECT_NEAR(feed(sensors), 0.5, 0.1);
}

TEST_F(SensorPipelineTest, WhatIsAskedIsLookedUpInTheMapThatHoldsTheScan) {
  advance(1);
  question.ahead = {Vec3(0, 0, 0), Vec3(6, 0, 0)};  // through the rock that the scan shows, and beyond
  question.frontier = 9;                            // there is none of that number
  sensors.on_lidar(scan(now()));
  advance(0.2);
  ASSERT_EQ(news.size(), 1u);
  ASSERT_TRUE(news[0].blocked_after_m);
  EXPECT_EQ(*news[0].blocked_after_m, 0) << "from the beginning of the only segment on";
  EXPECT_EQ(news[0].frontier, 9u);
  EXPECT_FALSE(news[0].frontier_open);
}

TEST_F(SensorPipelineTest, BodiesInTheAirAreReportedOnlyWhileTheyAreLookedFor) {
  auto dense = std::make_shared<LidarModel>(*onboard.vehicle.lidar);
  dense->columns = 360;
  dense->elevation_rad.clear();
  for (int i = 0; i < 20; ++i) dense->elevation_rad.push_back(0.3f - 0.03f * static_cast<float>(i));
  const auto scan_of = [&](bool body) {  // of 0.5 m, 1.5 m away from the vehicle
    auto s = std::make_shared<LidarScan>();
    s->stamp = now();
    s->model = dense;
    s->intensity.assign(20 * 360, 0.5f);
    for (int ring = 0; ring < 20; ++ring)
      for (int column = 0; column < 360; ++column)
        s->range_m.push_back(body && ring > 5 && ring < 15 && column < 20 ? 1.5f : 3.0f);
    return s;
  };
  const auto bodies_seen = [&] {
    for (int i = 0; i < 20; ++i) {
      advance(0.1);
      sensors.on_lidar(scan_of(false));
    }
    advance(0.1);
    news.clear();
    sensors.on_lidar(scan_of(true));
    advance(0.1);
    return news.size() == 1 ? static_cast<int>(news.back().bodies.size()) : -1;
  };
  EXPECT_EQ(bodies_seen(), 0);
  look_for_others = true;
  EXPECT_EQ(bodies_seen(), 1);
}

TEST_F(SensorPipelineTest, WhatIsSeenOfAnotherVehicleIsNoRock) {
  const auto rock = [this] {
    std::size_t n = 0;
    for (const CellChange& c : news.back().changes) n += c.after == Cell::occupied;
    return n;
  };
  advance(1);
  others = {{Vec3::Zero(), 4.0}};  // all around
  sensors.on_lidar(scan(now()));
  advance(0.2);
  ASSERT_EQ(news.size(), 1u);
  EXPECT_EQ(rock(), 0u);
  others.clear();
  for (int i = 0; i < 3; ++i) sensors.on_lidar(scan(now()));
  advance(0.2);
  std::size_t seen = 0;
  for (const MapNews& n : news)
    for (const CellChange& c : n.changes) seen += c.after == Cell::occupied;
  EXPECT_GT(seen, 0u);
}

/// How many of 40 scans are mapped with what the load leaves out.
TEST_F(SensorPipelineTest, WhatALateMapLaneLeavesOutIsNotMapped) {
  const auto mapped_of_40 = [this] {
    news.clear();
    for (int i = 0; i < 40; ++i) {
      advance(0.1);
      sensors.on_lidar(scan(now()));
    }
    advance(0.2);
    return news.size();
  };
  auto late_for_a_second = [this, t = TimeNs{0}]() mutable {
    for (int i = 0; i < 10; ++i) onboard.load.observe_map(t += 100 * kMillisecond, kSecond);
  };
  EXPECT_EQ(mapped_of_40(), 40u);
  late_for_a_second();
  ASSERT_TRUE(onboard.load.sheds(Relief::half_the_scans));
  EXPECT_EQ(mapped_of_40(), 20u);
  late_for_a_second();
  ASSERT_TRUE(onboard.load.sheds(Relief::quarter_the_scans));
  EXPECT_EQ(mapped_of_40(), 10u);
}

}  // namespace
}  // namespace karst::core
