#include <algorithm>
#include <cmath>

#include "sdk/mcap_export/flight_messages.h"
#include "sdk/mcap_export/flight_topics.h"
#include "sdk/mcap_export/ros_values.h"

namespace karst::mcap {
namespace {

using core::Vec3;
using evaluation::RunRecord;
using evaluation::StampedPose;
using Poses = std::vector<StampedPose>;

/// Row of a table that was current at a time: the last not after it, or none.
std::optional<std::size_t> row_at(const std::vector<double>* times, double t_s) {
  if (!times) return std::nullopt;
  const auto after = std::upper_bound(times->begin(), times->end(), t_s + kTimeRounding_s);
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
  if (!row || std::abs((*times)[*row] - t_s) > kSameTime_s) return std::nullopt;
  const Vec3 v(cell(run.telemetry, "vx", *row), cell(run.telemetry, "vy", *row),
               cell(run.telemetry, "vz", *row));
  return v.allFinite() ? std::optional(v) : std::nullopt;
}

std::optional<PoseSigmas> sigmas_at(const evaluation::Table& localization, double t_s) {
  const auto row = row_at(localization.column("used_s"), t_s);
  if (!row) return std::nullopt;
  return PoseSigmas{cell(localization, "position_sigma_m", *row),
                    cell(localization, "heading_sigma_rad", *row)};
}

PoseInFlight in_flight(const Poses& poses, std::size_t i) {
  return {poses[i > 0 ? i - 1 : i], poses[i], poses[std::min(i + 1, poses.size() - 1)]};
}

Topic tf_topic(const Poses& poses, const FlightClock& clock, const char* body_frame) {
  return topic_of<ros::TFMessage>("/tf", clock, poses.size(), [&poses, clock, body_frame](std::size_t i) {
    return std::pair(poses[i].t_s, tf_of(poses[i], clock, body_frame));
  });
}

ros::Path path_until(const Poses& poses, double end_s, const FlightClock& clock) {
  FlownPath path;
  for (const StampedPose& p : poses) {
    if (p.t_s > end_s) break;
    path.add(p, clock);
  }
  return path.until(end_s, clock);
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
  topics.push_back(topic_of<ros::Odometry>(
      "/odometry", clock, estimate.size(), [&run, &estimate, clock, localization](std::size_t i) {
        const double t_s = estimate[i].t_s;
        return std::pair(t_s, odometry_of(in_flight(estimate, i), clock, kBodyFrame,
                                          estimated_velocity(run, t_s), sigmas_at(*localization, t_s)));
      }));
  topics.push_back(
      topic_of<ros::Odometry>("/truth/odometry", clock, truth.size(), [&truth, clock](std::size_t i) {
        return std::pair(truth[i].t_s, odometry_of(in_flight(truth, i), clock, kTrueBodyFrame, {}, {}));
      }));
  const auto times = estimate.empty() ? std::vector<double>{} : snapshot_times(estimate.back().t_s);
  topics.push_back(
      topic_of<ros::Path>("/path", clock, times.size(), [&estimate, clock, times](std::size_t i) {
        return std::pair(times[i], path_until(estimate, times[i], clock));
      }));
  return topics;
}

Topic battery_topic(const RunRecord& run, const FlightClock& clock) {
  BatteryPace pace;
  std::vector<std::size_t> rows;
  const auto* times = run.telemetry.times();
  const auto* fraction = run.telemetry.column("battery_fraction");
  for (std::size_t i = 0; times && fraction && i < times->size(); ++i)
    if (pace.takes((*times)[i], (*fraction)[i])) rows.push_back(i);
  return topic_of<ros::BatteryState>("/battery", clock, rows.size(),
                                     [clock, times, fraction, rows](std::size_t i) {
                                       const double t_s = (*times)[rows[i]];
                                       return std::pair(t_s, battery_of(t_s, (*fraction)[rows[i]], clock));
                                     });
}

}  // namespace karst::mcap
