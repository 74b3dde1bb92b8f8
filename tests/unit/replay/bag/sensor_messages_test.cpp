// Scans whose definition, which comes with the bag, gives their sizes other types than ROS does.
#include "plugins/replay/bag/sensor_messages.h"

#include <gtest/gtest.h>

#include "core_stack/common/input_file.h"
#include "tests/unit/replay/bag/bag_writer.h"

namespace karst::replay {
namespace {

using test::Serializer;

std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// Ten points of 16 bytes.
template <class Width, class Offset>
std::string ten_points(Width width, Offset offset) {
  Serializer s(Serializer::cdr_little);
  s.header(core::kSecond, "lidar").number(std::uint32_t{1}).number(width).number(std::uint32_t{3});
  for (const char* axis : {"x", "y", "z"})
    s.text(axis).number(offset).number(std::uint8_t{7}).number(std::uint32_t{1});
  s.number(std::uint8_t{0}).number(std::uint32_t{16}).number(std::uint32_t{160});
  return s.blob(std::string(160, '\0')).number(std::uint8_t{1}).bytes();
}

std::string refusal(const std::string& definition, const std::string& bytes) {
  const MessageType type = parse_message_type("sensor_msgs/PointCloud2", definition, Dialect::ros2);
  try {
    return std::to_string(
        cloud_of("sensor_msgs/PointCloud2", Message::of(type, bytes, Dialect::ros2), {}).scan.points.size());
  } catch (const MalformedError& e) {
    return e.what();
  }
}

TEST(SensorMessages, SizesWhoseTypesTheBagWidenedAreRefusedBeyond32Bits) {
  const std::string usual = known_definition("sensor_msgs/PointCloud2", Dialect::ros2);
  EXPECT_EQ(refusal(usual, ten_points(std::uint32_t{10}, std::uint32_t{0})), "10");
  const std::string wide = with(usual, "uint32 width", "uint64 width");
  EXPECT_EQ(refusal(wide, ten_points(std::uint64_t{10}, std::uint32_t{0})), "10");
  for (const std::uint64_t width : {1ull << 60, 1ull << 32, ~0ull})  // 2^60 points of 16 bytes are 2^64
    EXPECT_NE(refusal(wide, ten_points(width, std::uint32_t{0})).find("width"), std::string::npos) << width;
  const std::string negative = with(usual, "uint32 offset", "int32 offset");
  EXPECT_NE(refusal(negative, ten_points(std::uint32_t{10}, std::int32_t{-(1 << 30)})).find("offset"),
            std::string::npos);
}

TEST(SensorMessages, StampsOfWideTypesAreRefused) {
  const MessageType type = parse_message_type(
      "p/T", "Head header\n====\nMSG: p/Head\nStamp stamp\n====\nMSG: p/Stamp\nint64 sec\nuint32 nanosec\n",
      Dialect::ros1);
  Serializer s(Serializer::ros1);
  s.number(std::int64_t{1} << 60).number(std::uint32_t{0});
  EXPECT_THROW(stamp_of(Message::of(type, s.bytes(), Dialect::ros1)), MalformedError);
}

}  // namespace
}  // namespace karst::replay
