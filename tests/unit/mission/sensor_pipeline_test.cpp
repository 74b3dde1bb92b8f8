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
  SensorPipeline sensors{onboard,
                         {.ask = [this] { return question; },
                          .tell = [this](const MapNews& n) { news.push_back(n); },
                          .others = [this](TimeNs) { return others; }}};
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
      onboard.flight.on_imu({now(), Vec3(0, 0, 9.81), Vec3::Zero()});
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

}  // namespace
}  // namespace karst::core
