#include "sdk/mcap_export/flight_messages.h"

#include <cmath>
#include <limits>

#include "core_stack/common/so3.h"
#include "sdk/mcap_export/flight_topics.h"
#include "sdk/mcap_export/point_cloud.h"
#include "sdk/mcap_export/ros_values.h"

namespace karst::mcap {
namespace {

using core::Vec3;
using evaluation::StampedPose;
using ros::PointType;

struct Motion {
  Vec3 velocity_mps = Vec3::Zero();  // world frame
  Vec3 body_rate_radps = Vec3::Zero();
};

Motion motion_between(const StampedPose& a, const StampedPose& b) {
  const double dt_s = b.t_s - a.t_s;
  if (dt_s <= 0) return {};
  return {(b.T_world_body.position - a.T_world_body.position) / dt_s,
          core::log_so3(a.T_world_body.orientation.conjugate() * b.T_world_body.orientation) / dt_s};
}

}  // namespace

ros::TFMessage tf_of(const StampedPose& pose, const FlightClock& clock, const char* body_frame) {
  return {{ros::TransformStamped{
      {clock.stamp(pose.t_s), kMapFrame}, body_frame, ros::transform(pose.T_world_body)}}};
}

ros::Odometry odometry_of(const PoseInFlight& in_flight, const FlightClock& clock, const char* body_frame,
                          const std::optional<Vec3>& velocity_mps, const std::optional<PoseSigmas>& sigmas) {
  const auto& [before, pose, after] = in_flight;
  const Motion motion = motion_between(before, after);
  ros::Odometry out{{clock.stamp(pose.t_s), kMapFrame}, body_frame, {}, {}};
  out.pose.pose = ros::pose(pose.T_world_body);
  // By ROS's convention in the frame of the body.
  out.twist.twist.linear =
      ros::vector3(pose.T_world_body.orientation.conjugate() * velocity_mps.value_or(motion.velocity_mps));
  out.twist.twist.angular = ros::vector3(motion.body_rate_radps);
  if (!sigmas || !std::isfinite(sigmas->position_m) || !std::isfinite(sigmas->heading_rad)) return out;
  // Variances of x, y, z and of the turns about them. Gravity tells roll and pitch better than the heading is
  // known.
  for (std::size_t i = 0; i < 6; ++i) {
    const double sigma = i < 3 ? sigmas->position_m : sigmas->heading_rad;
    out.pose.covariance[7 * i] = sigma * sigma;
  }
  return out;
}

void FlownPath::add(const StampedPose& pose, const FlightClock& clock) {
  constexpr double kStep_m = 0.05;
  if (last_ && (pose.T_world_body.position - *last_).norm() < kStep_m) return;
  poses_.push_back({{clock.stamp(pose.t_s), kMapFrame}, ros::pose(pose.T_world_body)});
  last_ = pose.T_world_body.position;
}

ros::Path FlownPath::until(double t_s, const FlightClock& clock) const {
  return {{clock.stamp(t_s), kMapFrame}, poses_};
}

ros::BatteryState battery_of(double t_s, double fraction, const FlightClock& clock) {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  constexpr std::uint8_t kDischarging = 2;
  ros::BatteryState out;
  out.header = {clock.stamp(t_s), kBodyFrame};
  for (float* unknown :
       {&out.voltage, &out.temperature, &out.current, &out.charge, &out.capacity, &out.design_capacity})
    *unknown = kUnknown;
  out.percentage = static_cast<float>(fraction);
  out.power_supply_status = kDischarging;
  out.present = true;
  return out;
}

bool BatteryPace::takes(double t_s, double fraction) {
  if (!std::isfinite(fraction) || (last_s_ && std::floor(t_s) <= std::floor(*last_s_))) return false;
  last_s_ = t_s;
  return true;
}

ros::PointCloud2 cells_cloud(double t_s, const FlightClock& clock) {
  return ros::empty_cloud({clock.stamp(t_s), kMapFrame}, {{"x", PointType::float32},
                                                          {"y", PointType::float32},
                                                          {"z", PointType::float32},
                                                          {"since", PointType::float32}});
}

void append_cell(ros::PointCloud2& cloud, const core::CellKey& key, double resolution_m, double since_s) {
  for (const std::int32_t k : {key.x, key.y, key.z})
    ros::append(cloud, static_cast<float>((k + 0.5) * resolution_m));
  ros::append(cloud, static_cast<float>(since_s));
}

ros::PointCloud2 map_cloud(const core::VoxelMap& map, double t_s, const FlightClock& clock,
                           const std::function<double(const core::CellKey&)>& since_s) {
  ros::PointCloud2 cloud = cells_cloud(t_s, clock);
  map.for_each_known([&](const core::CellKey& key, core::Cell cell, float) {
    if (cell == core::Cell::occupied) append_cell(cloud, key, map.resolution_m(), since_s(key));
  });
  return ros::finished(std::move(cloud));
}

}  // namespace karst::mcap
