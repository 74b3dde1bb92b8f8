// karst's values as parts of ROS messages.
#pragma once
#include "core_stack/common/geometry.h"
#include "sdk/mcap_export/ros_messages.h"

namespace karst::ros {

inline Point point(const core::Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline Vector3 vector3(const core::Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline Quaternion quaternion(const core::Quat& q) { return {q.x(), q.y(), q.z(), q.w()}; }
inline Pose pose(const core::Pose& T) { return {point(T.position), quaternion(T.orientation)}; }
inline Transform transform(const core::Pose& T) { return {vector3(T.position), quaternion(T.orientation)}; }

}  // namespace karst::ros
