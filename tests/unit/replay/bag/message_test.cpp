// Definitions of messages, and messages decoded by them, against bytes worked out by hand.
#include "plugins/replay/bag/message.h"

#include <gtest/gtest.h>

#include "plugins/replay/bag/bag.h"
#include "tests/unit/replay/bag/bag_writer.h"

namespace karst::replay {
namespace {

using test::Serializer;

std::vector<std::string> paths_of(const MessageType& type) {
  std::vector<std::string> paths;
  for (const MessageField& f : type.fields) paths.push_back(f.path);
  return paths;
}

constexpr const char* kNested =
    "# a comment\n"
    "std_msgs/Header header   # another\n"
    "int32 MODE_A=1\n"
    "string NAME = x # y\n"
    "uint8[] data\n"
    "geometry/Pair[2] pairs\n"
    "string<=10 name\n"
    "float32[<=3] few\n"
    "float64 scale 1.5\n"
    "================================================================================\n"
    "MSG: std_msgs/Header\n"
    "uint32 seq\ntime stamp\nstring frame_id\n"
    "================================================================================\n"
    "MSG: geometry/Pair\n"
    "uint8 a\nOther b\n"
    "================================================================================\n"
    "MSG: geometry/Other\n"
    "float64 x\n";

TEST(MessageType, FlattensStructuresAndKeepsArraysOfThem) {
  const MessageType type = parse_message_type("package/Outer", kNested, Dialect::ros1);
  EXPECT_EQ(paths_of(type),
            (std::vector<std::string>{"header.seq", "header.stamp.sec", "header.stamp.nanosec",
                                      "header.frame_id", "data", "pairs", "name", "few", "scale"}));
  EXPECT_EQ(type.fields[5].count, 2u);
  EXPECT_EQ(paths_of(*type.fields[5].structure), (std::vector<std::string>{"a", "b.x"}));
  EXPECT_EQ(type.fields[8].number, ValueType::float64);
}

TEST(MessageType, TheBytesOfByteAndCharAreThoseOfTheDialect) {
  const auto type_of = [](Dialect d) {
    const MessageType t = parse_message_type("p/T", "byte a\nchar b\nbool c\n", d);
    return std::array{t.fields[0].number, t.fields[1].number, t.fields[2].number};
  };
  using enum ValueType;
  EXPECT_EQ(type_of(Dialect::ros1), (std::array{int8, uint8, uint8}));
  EXPECT_EQ(type_of(Dialect::ros2), (std::array{uint8, uint8, uint8}));
}

TEST(MessageType, SaysWhereADefinitionIsWrong) {
  const auto error_of = [](const std::string& text) {
    try {
      parse_message_type("p/T", text, Dialect::ros2);
    } catch (const MalformedError& e) {
      return std::string(e.what());
    }
    return std::string("parsed");
  };
  EXPECT_NE(error_of("uint8 a\nThing b\n").find("line 2 of the definition: the type p/Thing is not defined"),
            std::string::npos);
  EXPECT_NE(error_of("uint8\n").find("a type without a name"), std::string::npos);
  EXPECT_NE(error_of("uint8[x] a\n").find("the size of an array"), std::string::npos);
  EXPECT_NE(error_of("uint8[3 a\n").find("an array without its end"), std::string::npos);
  EXPECT_NE(error_of("T a\n").find("nested deeper"), std::string::npos);
  EXPECT_NE(error_of("T[] a\n").find("nested deeper"), std::string::npos);
  EXPECT_NE(error_of("uint8 a\n====\nuint8 b\n").find("MSG:"), std::string::npos);
}

/// Each level has two members of the next: 2^16 fields unless something stops it.
TEST(MessageType, ADefinitionThatDoublesAtEachLevelIsRefused) {
  std::string text = "L1 a\nL1 b\n";
  for (int i = 1; i < 16; ++i) {
    const std::string next = "L" + std::to_string(i + 1);
    text += "====\nMSG: p/L" + std::to_string(i) + "\n" + next + " a\n" + next + " b\n";
  }
  text += "====\nMSG: p/L16\nuint8 x\n";
  EXPECT_THROW(parse_message_type("p/T", text, Dialect::ros2), MalformedError);
}

TEST(Message, Ros1HasNoGapsAndCdrHasThem) {
  const MessageType type =
      parse_message_type("p/T", "uint8 a\nfloat64 b\nstring s\nint16[] n\nuint32 last\n", Dialect::ros2);
  const std::string one("\x07\0\0\0\0\0\0\xf8\x3f\x02\0\0\0hi\x02\0\0\0\xff\xff\x02\0\x04\x03\x02\x01", 27);
  const Message m1 = Message::of(type, one, Dialect::ros1);
  // Offsets after the four bytes of CDR: a 0, b 8, s 16 (length 3 with the zero), n 24, last 32.
  const std::string little(
      "\0\1\0\0\x07\0\0\0\0\0\0\0\0\0\0\0\0\0\xf8\x3f\x03\0\0\0hi\0\0\x02\0\0\0\xff\xff\x02\0\x04\x03\x02"
      "\x01",
      40);
  const Message m2 = Message::of(type, little, Dialect::ros2);
  const std::string big(
      "\0\0\0\0\x07\0\0\0\0\0\0\0\x3f\xf8\0\0\0\0\0\0\0\0\0\x03hi\0\0\0\0\0\x02\xff\xff\0\x02\x01\x02\x03"
      "\x04",
      40);
  const Message m3 = Message::of(type, big, Dialect::ros2);
  for (const Message* m : {&m1, &m2, &m3}) {
    EXPECT_EQ(m->whole("a"), 7);
    EXPECT_EQ(m->number("b"), 1.5);
    EXPECT_EQ(m->text("s"), "hi");
    const Bytes n = m->numbers("n", ValueType::int16);
    ASSERT_EQ(n.size(), 4u);
    EXPECT_EQ(value_at(n.data(), ValueType::int16, m->order()), -1);
    EXPECT_EQ(value_at(n.data() + 2, ValueType::int16, m->order()), 2);
    EXPECT_EQ(m->whole("last"), 0x01020304);
  }
  EXPECT_THROW(m1.number("c"), MalformedError);
  EXPECT_THROW(m1.text("a"), MalformedError);
  EXPECT_THROW(m1.whole("b"), MalformedError);
  for (std::size_t cut = 0; cut < little.size(); ++cut)
    EXPECT_THROW(Message::of(type, Bytes(little).first(cut), Dialect::ros2), MalformedError) << cut;
  for (std::size_t cut = 0; cut < one.size(); ++cut)
    EXPECT_THROW(Message::of(type, Bytes(one).first(cut), Dialect::ros1), MalformedError) << cut;
}

TEST(Message, OtherEncodingsThanCdrAreRefused) {
  const MessageType type = parse_message_type("p/T", "uint8 a\n", Dialect::ros2);
  EXPECT_THROW(Message::of(type, std::string("\0\7\0\0\1", 5), Dialect::ros2), MalformedError);
}

/// Livox' points have 19 bytes: in CDR each begins at a multiple of 4, in ROS 1 they touch.
TEST(Message, StructuresThatAreLaidOutAlikeAreRecords) {
  const MessageType type = parse_message_type(
      "p/T",
      "uint8 pad\nP[] points\nuint8 after\n====\nMSG: p/P\nuint32 t\nfloat32 x\nuint8 a\nuint8 b\nuint8 c\n",
      Dialect::ros2);
  for (const auto kind : {Serializer::ros1, Serializer::cdr_little, Serializer::cdr_big}) {
    Serializer s(kind);
    s.number(std::uint8_t{1}).number(std::uint32_t{3});
    for (std::uint32_t i = 0; i < 3; ++i)
      s.number(i)
          .number(0.5f * static_cast<float>(i))
          .number(std::uint8_t{1})
          .number(std::uint8_t{2})
          .number(static_cast<std::uint8_t>(i));
    s.number(std::uint8_t{9});
    const Message m = Message::of(type, s.bytes(), kind == Serializer::ros1 ? Dialect::ros1 : Dialect::ros2);
    const Message::Records r = m.records("points");
    ASSERT_EQ(r.count, 3u);
    EXPECT_EQ(r.stride, kind == Serializer::ros1 ? 11u : 12u);
    ASSERT_EQ(r.fields.size(), 5u);
    EXPECT_EQ(
        value_at(r.bytes.data() + 2 * r.stride + r.fields[1].second.offset, ValueType::float32, m.order()),
        1.0);
    EXPECT_EQ(
        value_at(r.bytes.data() + 2 * r.stride + r.fields[4].second.offset, ValueType::uint8, m.order()), 2);
    EXPECT_EQ(m.whole("after"), 9);
    EXPECT_EQ(m.structures("points").at(1).number("x"), 0.5);
  }
}

TEST(Message, ALengthThatLiesIsAnErrorAndNoMemory) {
  const MessageType type = parse_message_type("p/T", "P[] points\n====\nMSG: p/P\nstring s\n", Dialect::ros1);
  EXPECT_THROW(Message::of(type, std::string("\xff\xff\xff\xff\0\0\0\0", 8), Dialect::ros1), MalformedError);
  const MessageType numbers = parse_message_type("p/T", "float64[] n\n", Dialect::ros1);
  EXPECT_THROW(Message::of(numbers, std::string("\xff\xff\xff\x1f\0\0\0\0", 8), Dialect::ros1),
               MalformedError);
}

/// 1000^3 elements without a byte, of which reading each would take minutes.
TEST(Message, NestedArraysOfEmptyStructuresDoNotMultiply) {
  const MessageType type = parse_message_type(
      "a/T", "G[1000] g\n====\nMSG: a/G\nF[1000] f\n====\nMSG: a/F\nE[1000] e\n====\nMSG: a/E\n",
      Dialect::ros1);
  const Message m = Message::of(type, std::string(2000, '\0'), Dialect::ros1);
  EXPECT_EQ(m.structures("g").size(), 1000u);
}

TEST(Message, EveryKnownTypeIsWellDefinedInBothDialects) {
  for (const char* name :
       {"sensor_msgs/PointCloud2", "sensor_msgs/Imu", "sensor_msgs/MagneticField",
        "sensor_msgs/FluidPressure", "sensor_msgs/CompressedImage", "tf2_msgs/TFMessage", "nav_msgs/Odometry",
        "geometry_msgs/PoseStamped", "livox_ros_driver/CustomMsg", "livox_ros_driver2/CustomMsg"})
    for (const Dialect d : {Dialect::ros1, Dialect::ros2}) {
      const MessageType type = parse_message_type(name, known_definition(name, d), d);
      EXPECT_FALSE(type.fields.empty()) << name;
    }
  EXPECT_EQ(known_definition("std_msgs/String", Dialect::ros1), "");
}

}  // namespace
}  // namespace karst::replay
