// What the messages of LiDARs, IMUs and frames say.
#pragma once
#include <map>
#include <optional>

#include "core_stack/vehicle/messages.h"
#include "plugins/replay/bag/bag.h"
#include "plugins/replay/bag/message.h"
#include "plugins/replay/scan_files/scan.h"

namespace karst::replay {

/// Decodes the messages of a bag's connections; parses each type once.
class MessageDecoder {
 public:
  explicit MessageDecoder(const std::vector<Connection>& connections) : connections_(&connections) {}
  /// Throws MalformedError. The message views `bytes`.
  Message decode(std::size_t connection, Bytes bytes);

 private:
  const std::vector<Connection>* connections_;
  std::map<std::size_t, MessageType> types_;
};

/// True for the types that `cloud_of` reads: sensor_msgs/PointCloud2, livox_ros_driver(2)/CustomMsg.
bool is_cloud_type(std::string_view type);

struct CloudMessage {
  core::TimeNs stamp = 0;
  std::string frame;
  Scan scan;
  std::size_t declared = 0;  // points, those that are not finite too
};
struct CloudField {
  std::string name;
  ValueType type = ValueType::float32;
  Role role = Role::none;
};

core::TimeNs stamp_of(const Message& m);
std::string frame_of(const Message& m);

/// The points of a scan. Throws MalformedError where its sizes do not agree, or it has no x, y and z.
CloudMessage cloud_of(std::string_view type, const Message& m, const FieldNames& names);
/// Its fields as they are declared.
std::vector<CloudField> cloud_fields(std::string_view type, const Message& m, const FieldNames& names);

/// In the IMU's own frame and unit.
core::ImuSample imu_of(const Message& m);

struct FrameTransform {
  std::string parent, child;
  core::Pose T_parent_child;
};
std::vector<FrameTransform> transforms_of(const Message& m);
/// The pose of `to` in `from`, if transforms connect them.
std::optional<core::Pose> find_transform(const std::vector<FrameTransform>& transforms,
                                         const std::string& from, const std::string& to);

struct StampedPose {
  core::TimeNs stamp = 0;
  core::Pose T_world_body;
};
/// Of nav_msgs/Odometry or geometry_msgs/PoseStamped.
StampedPose pose_of(std::string_view type, const Message& m);

}  // namespace karst::replay
