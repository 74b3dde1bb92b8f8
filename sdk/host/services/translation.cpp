#include "sdk/host/services/translation.h"

#include <limits>
#include <numbers>

#include "sdk/host/boundary/text.h"
#include "sdk/host/services/snapshot.h"

namespace karst::host {
namespace {

karst_quaternion_t to_abi(const core::Quat& q) { return {q.w(), q.x(), q.y(), q.z()}; }
karst_pose_t to_abi(const core::Pose& p) { return {host::to_abi(p.position), to_abi(p.orientation)}; }

karst_state_t to_abi(const core::State& s) {
  return {s.stamp, host::to_abi(s.position), host::to_abi(s.velocity_mps), to_abi(s.orientation),
          host::to_abi(s.body_rate_radps)};
}

karst_frontier_cluster_t to_abi(const core::FrontierOffer& offer) {
  const core::FrontierCluster& c = *offer.cluster;
  karst_frontier_cluster_t out{};
  out.id = c.id;
  out.cells = static_cast<std::uint32_t>(c.cells.size());
  out.centroid = host::to_abi(c.centroid);
  out.bounds = {host::to_abi(c.low), host::to_abi(c.high)};
  out.normal = host::to_abi(c.normal);
  out.unknown_cells = c.unknown_cells;
  out.free_cells = c.free_cells;
  out.viewpoint = {host::to_abi(offer.viewpoint), offer.viewpoint_heading_rad};
  out.path_length_m = offer.path_length_m;
  return out;
}

karst_sensor_t to_abi(const core::LidarModel& l) {
  karst_sensor_t out{};
  out.kind = KARST_SENSOR_LIDAR;
  out.T_body_sensor = to_abi(l.T_body_lidar);
  out.min_range_m = static_cast<double>(l.min_range_m);
  out.max_range_m = static_cast<double>(l.max_range_m);
  out.horizontal_fov_rad = 2.0 * std::numbers::pi;
  out.low_elevation_rad = l.elevation_rad.empty() ? 0.0 : static_cast<double>(l.elevation_rad.back());
  out.high_elevation_rad = l.elevation_rad.empty() ? 0.0 : static_cast<double>(l.elevation_rad.front());
  return out;
}

karst_sensor_t to_abi(const core::CameraModel& c) {
  karst_sensor_t out{};
  out.kind = KARST_SENSOR_CAMERA;
  out.T_body_sensor = to_abi(c.T_body_camera);
  out.min_range_m = static_cast<double>(c.min_range_m);
  out.max_range_m = static_cast<double>(c.max_range_m);
  out.horizontal_fov_rad = c.horizontal_fov_rad;
  out.low_elevation_rad = -0.5 * c.vertical_fov_rad;
  out.high_elevation_rad = 0.5 * c.vertical_fov_rad;
  return out;
}

karst_teammate_t to_abi(const core::OtherVehicle& v) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  return {v.id,
          0,
          v.heard,
          host::to_abi(v.position),
          host::to_abi(v.velocity_mps),
          host::to_abi(v.goal.value_or(core::Vec3::Constant(nan))),
          v.seconds_before_homing};
}

karst_goal_fate_t to_abi(core::GoalFate fate) {
  switch (fate) {
    case core::GoalFate::under_way:
      return KARST_FATE_UNDER_WAY;
    case core::GoalFate::reached:
      return KARST_FATE_REACHED;
    case core::GoalFate::rejected:
      return KARST_FATE_REJECTED;
    case core::GoalFate::unreachable:
      return KARST_FATE_UNREACHABLE;
    case core::GoalFate::abandoned:
      return KARST_FATE_ABANDONED;
    case core::GoalFate::superseded:
      return KARST_FATE_SUPERSEDED;
    case core::GoalFate::none:
      break;
  }
  return KARST_FATE_NONE;
}

karst_event_kind_t to_abi(core::PolicyEvent::Kind kind) {
  using Kind = core::PolicyEvent::Kind;
  switch (kind) {
    case Kind::goal_reached:
      return KARST_EVENT_GOAL_REACHED;
    case Kind::goal_rejected:
      return KARST_EVENT_GOAL_REJECTED;
    case Kind::goal_unreachable:
      return KARST_EVENT_GOAL_UNREACHABLE;
    case Kind::goal_abandoned:
      return KARST_EVENT_GOAL_ABANDONED;
    case Kind::goal_superseded:
      return KARST_EVENT_GOAL_SUPERSEDED;
    case Kind::homing:
      break;
  }
  return KARST_EVENT_HOMING;
}

}  // namespace

karst_sensor_t to_abi(const core::RgbCameraModel& c) {
  karst_sensor_t out = to_abi(c.camera);
  out.kind = KARST_SENSOR_RGB;
  return out;
}

RequestPack::RequestPack(const core::DecisionRequest& r, const karst_map_t* map) {
  for (const core::FrontierOffer& offer : r.frontiers) frontiers_.push_back(to_abi(offer));
  if (r.vehicle != nullptr) {
    if (r.vehicle->lidar) {
      sensor_names_.push_back(r.vehicle->lidar->name);
      sensors_.push_back(to_abi(*r.vehicle->lidar));
    }
    for (const auto& camera : r.vehicle->cameras) {
      sensor_names_.push_back(camera->name);
      sensors_.push_back(to_abi(*camera));
    }
    if (r.vehicle->rgb) {
      sensor_names_.push_back(r.vehicle->rgb->camera.name);
      sensors_.push_back(to_abi(*r.vehicle->rgb));
    }
    for (std::size_t i = 0; i < sensors_.size(); ++i) sensors_[i].name = view_of(sensor_names_[i]);
  }
  request_.size = sizeof request_;
  request_.sequence = r.sequence;
  request_.stamp_ns = r.stamp;
  request_.deadline_ns = r.deadline;
  request_.state = to_abi(r.state);
  request_.direction_of_flight = host::to_abi(r.direction_of_flight);
  request_.T_world_start = to_abi(r.T_world_start);
  request_.seconds_before_homing = r.seconds_before_homing;
  request_.battery_fraction = r.battery_fraction;
  request_.battery_seconds_left = r.battery_seconds_left;
  request_.mission_seconds_left = r.mission_seconds_left;
  request_.max_speed_mps = r.max_speed_mps;
  request_.clearance_m = r.clearance_m;
  request_.vehicle_radius_m = r.vehicle_radius_m;
  request_.last_goal = host::to_abi(r.last_goal);
  request_.last_fate = to_abi(r.last_fate);
  request_.sensor_count = static_cast<std::uint32_t>(sensors_.size());
  request_.sensors = sensors_.data();
  request_.map = map;
  request_.frontiers = frontiers_.data();
  request_.frontier_count = frontiers_.size();
  for (const core::OtherVehicle& v : r.teammates) teammates_.push_back(to_abi(v));
  request_.teammates = teammates_.data();
  request_.teammate_count = teammates_.size();
}

karst_event_t to_abi(const core::PolicyEvent& event) {
  const core::Goal& g = event.goal;
  karst_event_t out{};
  out.size = sizeof out;
  out.kind = to_abi(event.kind);
  out.stamp_ns = event.stamp;
  out.goal = {to_abi(g.position), g.heading_rad, g.tolerance_m, g.max_speed_mps, g.frontier_id, 0, g.score,
              view_of(g.why)};
  out.reason = view_of(event.reason);
  return out;
}

}  // namespace karst::host
