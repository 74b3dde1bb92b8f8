// Several topics become one file in the order of time.
#include "sdk/mcap_export/topic.h"

#include <gtest/gtest.h>

#include <limits>
#include <sstream>

#include "sdk/mcap_export/flight_topics.h"
#include "sdk/mcap_export/markers.h"
#include "sdk/mcap_export/point_cloud.h"
#include "tests/unit/mcap_export/mcap_records_read.h"

namespace karst::mcap {
namespace {

Topic stamps(const std::string& name, const FlightClock& clock, const std::vector<double>& times) {
  std::vector<std::pair<double, ros::Header>> messages;
  for (const double t_s : times) messages.emplace_back(t_s, ros::Header{clock.stamp(t_s), name});
  return topic_of<ros::Header>(name, clock, std::move(messages));
}

std::vector<test::McapMessage> written(std::vector<Topic> topics, std::vector<TopicCount>* counts = nullptr) {
  std::ostringstream out;
  McapWriter writer(out, {.profile = "ros2", .library = "test"});
  const auto made = write_topics(writer, std::move(topics));
  if (counts) *counts = made;
  writer.finish();
  return test::messages_of(out.str());
}

TEST(WriteTopics, MergesByTimeAndAtOneTimeInTheOrderOfTheTopics) {
  std::vector<TopicCount> counts;
  const auto all =
      written({stamps("/a", {}, {1, 3, 3}), stamps("/none", {}, {}), stamps("/b", {}, {0.5, 3})}, &counts);
  std::string order;
  for (const auto& m : all) order += m.topic + std::to_string(m.time_ns / 500'000'000) + " ";
  EXPECT_EQ(order, "/b1 /a2 /a6 /a6 /b6 ");
  ASSERT_EQ(counts.size(), 2u);
  EXPECT_EQ(counts[0].name + std::to_string(counts[0].messages), "/a3");
  EXPECT_EQ(counts[1].name + std::to_string(counts[1].messages), "/b2");
  EXPECT_EQ(counts[1].type, "std_msgs/msg/Header");
}

TEST(WriteTopics, TopicsOfOneNameAreOneChannel) {
  std::vector<TopicCount> counts;
  const auto all = written({stamps("/tf", {}, {1, 3}), stamps("/tf", {}, {2})}, &counts);
  ASSERT_EQ(counts.size(), 1u);
  EXPECT_EQ(counts[0].messages, 3u);
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(all[i].sequence, i);
}

TEST(FlightClock, CountsFromItsEpochAndNeverBefore1970) {
  const FlightClock clock{1'700'000'000 * core::kSecond};
  EXPECT_EQ(clock.ns(1.5), 1'700'000'001'500'000'000u);
  EXPECT_EQ(clock.stamp(1.5).sec, 1'700'000'001);
  EXPECT_EQ(clock.stamp(1.5).nanosec, 500'000'000u);
  EXPECT_EQ(FlightClock{}.ns(-1), 0u);
}

TEST(SnapshotTimes, AreFewAndEndAtTheEnd) {
  EXPECT_EQ(snapshot_times(2.5), (std::vector<double>{1, 2, 2.5}));
  EXPECT_EQ(snapshot_times(0), (std::vector<double>{0}));
  for (const double end_s : {40.0, 41.0, 177.7, 3600.0, 100'000.5}) {
    const auto times = snapshot_times(end_s);
    EXPECT_LE(times.size(), 40u) << end_s;
    EXPECT_GE(times.size(), 20u) << end_s;
    EXPECT_EQ(times.back(), end_s);
    EXPECT_LT(times[times.size() - 2], end_s);
  }
}

TEST(PointCloud, FieldsFollowEachOtherAndTheSizesFit) {
  auto cloud = ros::empty_cloud(
      {}, {{"x", ros::PointType::float32}, {"t", ros::PointType::uint32}, {"ring", ros::PointType::uint16}});
  for (int i = 0; i < 3; ++i) {
    ros::append(cloud, 1.5f);
    ros::append(cloud, std::uint32_t{7});
    ros::append(cloud, std::uint16_t{9});
  }
  cloud = ros::finished(std::move(cloud));
  EXPECT_EQ(cloud.fields[2].offset, 8u);
  EXPECT_EQ(cloud.fields[2].datatype, 4);
  EXPECT_EQ(cloud.point_step, 10u);
  EXPECT_EQ(cloud.width, 3u);
  EXPECT_EQ(cloud.row_step, 30u);
  EXPECT_EQ(cloud.data.size(), 30u);
}

TEST(Markers, RemoveTheOnesBeforeAndKeepGroupAndNumber) {
  Markers markers({{}, "map"});
  markers.sphere("offered", 7, {1, 2, 3}, 0.5, kOffered);
  const std::vector<core::Vec3> three = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  markers.lines("lines", 1, three, kText);
  const ros::MarkerArray array = markers.take();
  ASSERT_EQ(array.markers.size(), 3u);
  EXPECT_EQ(array.markers[0].action, 3);  // DELETEALL
  EXPECT_EQ(array.markers[1].ns, "offered");
  EXPECT_EQ(array.markers[1].id, 7);
  EXPECT_EQ(array.markers[1].pose.position.z, 3);
  EXPECT_EQ(array.markers[2].points.size(), 2u);  // the third has no partner
}

}  // namespace
}  // namespace karst::mcap
