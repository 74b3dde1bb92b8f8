// Definitions of messages. interop.mjs compares them with those of ROS 2.
#include "sdk/mcap_export/message_schema.h"

#include <gtest/gtest.h>

#include "sdk/mcap_export/ros_messages.h"

namespace karst::ros {
namespace {

TEST(MessageSchema, ListsTheFieldsAndBehindThemEachTypeInsideOnce) {
  const MessageSchema schema = schema_of<Path>();
  const std::string line(80, '=');
  EXPECT_EQ(schema.name, "nav_msgs/msg/Path");
  EXPECT_EQ(
      schema.definition,
      "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n" + line +
          "\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" + line +
          "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n" + line +
          "\nMSG: geometry_msgs/PoseStamped\nstd_msgs/Header header\ngeometry_msgs/Pose pose\n" + line +
          "\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n" +
          line + "\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n" + line +
          "\nMSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n");
}

TEST(MessageSchema, NamesArraysSequencesAndBooleansAsRosDoes) {
  const std::string info = schema_of<CameraInfo>().definition;
  EXPECT_NE(info.find("float64[] d\nfloat64[9] k\n"), std::string::npos) << info;
  EXPECT_NE(info.find("bool do_rectify\n"), std::string::npos);
  EXPECT_NE(schema_of<PointCloud2>().definition.find("uint8[] data\nbool is_dense\n"), std::string::npos);
}

}  // namespace
}  // namespace karst::ros
