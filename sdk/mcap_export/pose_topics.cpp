#include <algorithm>
#include <cmath>

#include "core_stack/common/so3.h"
#include "sdk/mcap_export/flight_topics.h"
#include "sdk/mcap_export/ros_values.h"

namespace karst::mcap {
namespace {

using core::Vec3;
using evaluation::RunRecord;
using evaluation::StampedPose;
using Poses = std::vector<StampedPose>;

struct Motion {
  Vec3 velocity_mps = Vec3::Zero();  // world frame
  Vec3 body_rate_radps = Vec3::Zero();
};

/// From the pose before to the pose after.
Motion motion_at(const Poses& poses, std::size_t i) {
  const StampedPose& a = poses[i > 0 ? i - 1 : i];
  const StampedPose& b = poses[std::min(i + 1, poses.size() - 1)];
  const double dt_s = b.t_s - a.t_s;
  if (dt_s <= 0) return {};
  return {(b.T_world_body.position - a.T_world_body.position) / dt_s,
          core::log_so3(a.T_world_body.orientation.conjugate() * b.T_world_body.orientation) / dt_s};
}

/// Row of a table that was current at a time: the last not after it, or none.
std::optional<std::size_t> row_at(const std::vector<double>* times, double t_s) {
  if (!times) return std::nullopt;
  constexpr double kRounding_s = 0.006;  // of the columns, which have two decimals or three
  const auto after = std::upper_bound(times->begin(), times->end(), t_s + kRounding_s);
  if (after == times->begin()) return std::nullopt;
  return static_cast<std::size_t>(after - times->begin()) - 1;
}

double cell(const evaluation::Table& table, const char* column, std::size_t row) {
  const auto* values = table.column(column);
  return values ? (*values)[row] : std::nan("");
}

/// The estimator's own velocity where telemetry of that very time has it.
std::optional<Vec3> estimated_velocity(const RunRecord& run, double t_s) {
  const auto* times = run.telemetry.times();
  const auto row = row_at(times, t_s);
  if (!row || std::abs((*times)[*row] - t_s) > 0.01) return std::nullopt;
  const Vec3 v(cell(run.telemetry, "vx", *row), cell(run.telemetry, "vy", *row),
               cell(run.telemetry, "vz", *row));
  return v.allFinite() ? std::optional(v) : std::nullopt;
}

ros::Odometry odometry(const FlightClock& clock, const StampedPose& pose, const Motion& motion,
                       const char* body_frame) {
  ros::Odometry out{{clock.stamp(pose.t_s), kMapFrame}, body_frame, {}, {}};
  out.pose.pose = ros::pose(pose.T_world_body);
  // By ROS's convention in the frame of the body.
  out.twist.twist.linear = ros::vector3(pose.T_world_body.orientation.conjugate() * motion.velocity_mps);
  out.twist.twist.angular = ros::vector3(motion.body_rate_radps);
  return out;
}

/// Variances of x, y, z and of the turns about them. Gravity tells roll and pitch better than the heading is
/// known: that is their bound.
void put_covariance(ros::Odometry& out, const evaluation::Table& localization, double t_s) {
  const auto row = row_at(localization.column("used_s"), t_s);
  if (!row) return;
  const double position_m = cell(localization, "position_sigma_m", *row);
  const double heading_rad = cell(localization, "heading_sigma_rad", *row);
  if (!std::isfinite(position_m) || !std::isfinite(heading_rad)) return;
  for (std::size_t i = 0; i < 6; ++i)
    out.pose.covariance[7 * i] = i < 3 ? position_m * position_m : heading_rad * heading_rad;
}

Topic tf_topic(const Poses& poses, const FlightClock& clock, const char* body_frame) {
  return topic_of<ros::TFMessage>("/tf", clock, poses.size(), [&poses, clock, body_frame](std::size_t i) {
    const StampedPose& p = poses[i];
    return std::pair(p.t_s,
                     ros::TFMessage{{ros::TransformStamped{
                         {clock.stamp(p.t_s), kMapFrame}, body_frame, ros::transform(p.T_world_body)}}});
  });
}

/// Poses a step apart: a vehicle that hovers adds none.
ros::Path path_until(const Poses& poses, double end_s, const FlightClock& clock) {
  constexpr double kStep_m = 0.05;
  ros::Path path{{clock.stamp(end_s), kMapFrame}, {}};
  const StampedPose* last = nullptr;
  for (const StampedPose& p : poses) {
    if (p.t_s > end_s) break;
    if (last && (p.T_world_body.position - last->T_world_body.position).norm() < kStep_m) continue;
    path.poses.push_back({{clock.stamp(p.t_s), kMapFrame}, ros::pose(p.T_world_body)});
    last = &p;
  }
  return path;
}

}  // namespace

Topic static_transform(const FlightClock& clock, const char* parent, const char* child,
                       const core::Pose& T_parent_child) {
  const ros::TransformStamped transform{{clock.stamp(0), parent}, child, ros::transform(T_parent_child)};
  return topic_of<ros::TFMessage>("/tf_static", clock, {{0.0, ros::TFMessage{{transform}}}},
                                  Durability::latched);
}

std::vector<double> snapshot_times(double end_s) {
  constexpr double kMost = 40;
  const double step_s = std::max(1.0, std::ceil(end_s / kMost));
  std::vector<double> times;
  for (int i = 1; i * step_s < end_s; ++i) times.push_back(i * step_s);
  times.push_back(end_s);
  return times;
}

std::vector<Topic> pose_topics(const RunRecord& run, const FlightClock& clock) {
  const Poses &estimate = run.estimate, &truth = run.truth;
  auto localization = std::make_shared<evaluation::Table>();
  std::vector<std::string> ignored;  // the estimate is exported all the same
  *localization =
      evaluation::read_table(run.directory / "localization.csv", {"believed", "problem"}, ignored);
  std::vector<Topic> topics;
  topics.push_back(tf_topic(estimate, clock, kBodyFrame));
  topics.push_back(tf_topic(truth, clock, kTrueBodyFrame));
  topics.push_back(topic_of<ros::Odometry>("/odometry", clock, estimate.size(),
                                           [&run, &estimate, clock, localization](std::size_t i) {
                                             const StampedPose& p = estimate[i];
                                             Motion motion = motion_at(estimate, i);
                                             if (const auto v = estimated_velocity(run, p.t_s))
                                               motion.velocity_mps = *v;
                                             ros::Odometry out = odometry(clock, p, motion, kBodyFrame);
                                             put_covariance(out, *localization, p.t_s);
                                             return std::pair(p.t_s, std::move(out));
                                           }));
  topics.push_back(
      topic_of<ros::Odometry>("/truth/odometry", clock, truth.size(), [&truth, clock](std::size_t i) {
        return std::pair(truth[i].t_s, odometry(clock, truth[i], motion_at(truth, i), kTrueBodyFrame));
      }));
  const auto times = estimate.empty() ? std::vector<double>{} : snapshot_times(estimate.back().t_s);
  topics.push_back(
      topic_of<ros::Path>("/path", clock, times.size(), [&estimate, clock, times](std::size_t i) {
        return std::pair(times[i], path_until(estimate, times[i], clock));
      }));
  return topics;
}

Topic battery_topic(const RunRecord& run, const FlightClock& clock) {
  // Once a second is enough of what changes by a thousandth in it.
  std::vector<std::size_t> rows;
  const auto* times = run.telemetry.times();
  const auto* fraction = run.telemetry.column("battery_fraction");
  for (std::size_t i = 0; times && fraction && i < times->size(); ++i)
    if (std::isfinite((*fraction)[i]) &&
        (rows.empty() || std::floor((*times)[i]) > std::floor((*times)[rows.back()])))
      rows.push_back(i);
  return topic_of<ros::BatteryState>(
      "/battery", clock, rows.size(), [clock, times, fraction, rows](std::size_t i) {
        constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
        constexpr std::uint8_t kDischarging = 2;
        const double t_s = (*times)[rows[i]];
        ros::BatteryState out;
        out.header = {clock.stamp(t_s), kBodyFrame};
        for (float* unknown :
             {&out.voltage, &out.temperature, &out.current, &out.charge, &out.capacity, &out.design_capacity})
          *unknown = kUnknown;
        out.percentage = static_cast<float>((*fraction)[rows[i]]);
        out.power_supply_status = kDischarging;
        out.present = true;
        return std::pair(t_s, std::move(out));
      });
}

}  // namespace karst::mcap
