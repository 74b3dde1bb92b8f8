// The members of the types that karst reads, for bags that do not contain them: facts of the packages
// common_interfaces and livox_ros_driver(2), without their comments.
#include <array>
#include <string>

#include "plugins/replay/bag/message_type.h"

namespace karst::replay {
namespace {

struct KnownType {
  std::string_view name, text;
};

// The same in ROS 1 and ROS 2, except for std_msgs/Header and times.
constexpr std::array kKnown = {
    KnownType{
        "sensor_msgs/PointCloud2",
        "std_msgs/Header header\nuint32 height\nuint32 width\nPointField[] fields\nbool is_bigendian\n"
        "uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n"
        "====\nMSG: sensor_msgs/PointField\nstring name\nuint32 offset\nuint8 datatype\nuint32 count\n"},
    KnownType{
        "sensor_msgs/Imu",
        "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n"
        "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n"
        "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n"},
    KnownType{"sensor_msgs/MagneticField",
              "std_msgs/Header header\ngeometry_msgs/Vector3 magnetic_field\nfloat64[9] "
              "magnetic_field_covariance\n"},
    KnownType{"sensor_msgs/FluidPressure",
              "std_msgs/Header header\nfloat64 fluid_pressure\nfloat64 variance\n"},
    KnownType{"sensor_msgs/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data\n"},
    KnownType{"tf2_msgs/TFMessage",
              "geometry_msgs/TransformStamped[] transforms\n"
              "====\nMSG: geometry_msgs/TransformStamped\nstd_msgs/Header header\nstring child_frame_id\n"
              "Transform transform\n====\nMSG: geometry_msgs/Transform\nVector3 translation\nQuaternion "
              "rotation\n"},
    KnownType{"nav_msgs/Odometry",
              "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
              "geometry_msgs/TwistWithCovariance twist\n"
              "====\nMSG: geometry_msgs/PoseWithCovariance\nPose pose\nfloat64[36] covariance\n"
              "====\nMSG: geometry_msgs/TwistWithCovariance\nTwist twist\nfloat64[36] covariance\n"
              "====\nMSG: geometry_msgs/Twist\nVector3 linear\nVector3 angular\n"},
    KnownType{"geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"},
    KnownType{
        "livox_ros_driver2/CustomMsg",
        "std_msgs/Header header\nuint64 timebase\nuint32 point_num\nuint8 lidar_id\nuint8[3] rsvd\n"
        "CustomPoint[] points\n====\nMSG: livox_ros_driver2/CustomPoint\nuint32 offset_time\nfloat32 x\n"
        "float32 y\nfloat32 z\nuint8 reflectivity\nuint8 tag\nuint8 line\n"},
};
constexpr std::string_view kCommonParts =
    "====\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"
    "====\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n"
    "====\nMSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"
    "====\nMSG: geometry_msgs/Pose\nPoint position\nQuaternion orientation\n";
constexpr std::string_view kHeader1 = "====\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n";
constexpr std::string_view kHeader2 =
    "====\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
    "====\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";

}  // namespace

std::string known_definition(std::string_view name, Dialect dialect) {
  // Both drivers of Livox have the same messages.
  const bool of_old_driver = name == "livox_ros_driver/CustomMsg";
  for (const KnownType& known : kKnown)
    if (name == known.name || (of_old_driver && known.name == "livox_ros_driver2/CustomMsg")) {
      std::string text = std::string(known.text) + std::string(kCommonParts) +
                         std::string(dialect == Dialect::ros1 ? kHeader1 : kHeader2);
      if (of_old_driver) {
        const std::string_view now = "livox_ros_driver2/CustomPoint";
        text.replace(text.find(now), now.size(), "livox_ros_driver/CustomPoint");
      }
      return text;
    }
  return "";
}

}  // namespace karst::replay
