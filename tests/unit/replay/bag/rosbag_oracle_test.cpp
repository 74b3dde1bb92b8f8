// Bags written by ROS 1's own library are read, and those of our writer are read by it.
#include <gtest/gtest.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "plugins/replay/bag/bag.h"
#include "tests/unit/replay/bag/bag_writer.h"
#include "tests/unit/replay/folder.h"

namespace karst::test {

/// A message of any type, as its bytes.
struct RawMessage {
  std::string type, definition, bytes;
};

}  // namespace karst::test

namespace ros {
using karst::test::RawMessage;
namespace message_traits {
template <>
struct MD5Sum<RawMessage> {
  static const char* value(const RawMessage&) { return "00000000000000000000000000000001"; }
  static const char* value() { return "*"; }
};
template <>
struct DataType<RawMessage> {
  static const char* value(const RawMessage& m) { return m.type.c_str(); }
  static const char* value() { return "*"; }
};
template <>
struct Definition<RawMessage> {
  static const char* value(const RawMessage& m) { return m.definition.c_str(); }
};
template <>
struct IsMessage<RawMessage> : TrueType {};
}  // namespace message_traits
namespace serialization {
template <>
struct Serializer<RawMessage> {
  template <typename Stream>
  static void write(Stream& stream, const RawMessage& m) {
    std::memcpy(stream.advance(static_cast<uint32_t>(m.bytes.size())), m.bytes.data(), m.bytes.size());
  }
  template <typename Stream>
  static void read(Stream& stream, RawMessage& m) {
    const uint32_t size = stream.getLength();
    m.bytes.assign(reinterpret_cast<const char*>(stream.advance(size)), size);
  }
  static uint32_t serializedLength(const RawMessage& m) { return static_cast<uint32_t>(m.bytes.size()); }
};
}  // namespace serialization
}  // namespace ros

namespace karst::replay {
namespace {

using Row = std::tuple<std::string, core::TimeNs, std::string>;  // topic, time, bytes

struct Content {
  std::vector<test::WrittenTopic> topics = {{"/points", "sensor_msgs/PointCloud2", "uint8[] data\n"},
                                            {"/imu", "sensor_msgs/Imu", "float64 x\nuint32 count\n"},
                                            {"/empty", "std_msgs/Empty", "\n"}};
  std::vector<test::WrittenMessage> messages;
  Content() {
    for (int i = 0; i < 400; ++i) {
      const std::size_t topic = i % 20 == 0 ? 0 : i % 50 == 7 ? 2 : 1;
      std::string bytes;
      for (int k = 0; k < (topic == 0 ? 9000 : topic == 1 ? 12 : 0); ++k)
        bytes += static_cast<char>((i * k) % 251);
      messages.push_back({topic, core::kSecond * 1'600'000'000 + 5'000'000 * i + 1, bytes});
    }
  }
  std::vector<Row> rows() const {
    std::vector<Row> r;
    for (const auto& m : messages) r.emplace_back(topics[m.topic].topic, m.time, m.bytes);
    return r;
  }
};

std::vector<Row> read_by_karst(const std::string& path) {
  const auto bag = open_bag(path);
  std::vector<Row> rows;
  while (const auto m = bag->next())
    rows.emplace_back(bag->connections()[m->connection].topic, m->time,
                      std::string(m->bytes.begin(), m->bytes.end()));
  EXPECT_EQ(bag->faults().count(), 0u);
  return rows;
}

TEST(RosbagOracle, BagsOfRosbagAreReadWithEachCompression) {
  const Content content;
  test::Folder dir;
  using rosbag::compression::CompressionType;
  for (const auto& [compression, name] : {std::pair{CompressionType::Uncompressed, "none.bag"},
                                          {CompressionType::BZ2, "bz2.bag"},
                                          {CompressionType::LZ4, "lz4.bag"}}) {
    const std::string path = (dir.path() / name).string();
    rosbag::Bag bag;
    bag.open(path, rosbag::bagmode::Write);
    bag.setCompression(compression);
    bag.setChunkThreshold(20'000);
    for (const auto& m : content.messages)
      bag.write(content.topics[m.topic].topic,
                ros::Time(static_cast<uint32_t>(m.time / core::kSecond),
                          static_cast<uint32_t>(m.time % core::kSecond)),
                test::RawMessage{content.topics[m.topic].type, content.topics[m.topic].definition, m.bytes});
    bag.close();
    EXPECT_EQ(read_by_karst(path), content.rows()) << name;
    const auto read = open_bag(path);
    for (const Connection& c : read->connections()) {
      const auto topic = std::find_if(content.topics.begin(), content.topics.end(),
                                      [&](const auto& t) { return t.topic == c.topic; });
      ASSERT_NE(topic, content.topics.end());
      EXPECT_EQ(c.type, topic->type);
      EXPECT_EQ(c.definition, topic->definition);
    }
  }
}

TEST(RosbagOracle, OurWritersBagsAreReadByRosbag) {
  const Content content;
  test::Folder dir;
  for (const Compression c : {Compression::none, Compression::bz2, Compression::lz4}) {
    const std::string path =
        dir.write("ours.bag", test::ros1_bag(content.topics, content.messages, {c, true, 30}));
    rosbag::Bag bag(path);
    rosbag::View view(bag);
    std::vector<Row> rows;
    for (const rosbag::MessageInstance& m : view) {
      std::string bytes(m.size(), '\0');
      ros::serialization::OStream stream(reinterpret_cast<uint8_t*>(bytes.data()), m.size());
      m.write(stream);
      rows.emplace_back(m.getTopic(), core::kSecond * m.getTime().sec + m.getTime().nsec, bytes);
    }
    EXPECT_EQ(rows, content.rows()) << core::name_of(c);
  }
}

}  // namespace
}  // namespace karst::replay
