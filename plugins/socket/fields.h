// The fields of each message and of the structures inside, in the order of the wire. One list serves the
// encoder, the decoder and the test of the schema: a visitor is called with the name and the value of each
// field.
#pragma once
#include <concepts>
#include <type_traits>

#include "plugins/socket/messages.h"

namespace karst::socket {

/// T, const or not: a list serves readers, which change the message, and writers, which do not.
template <class M, class T>
concept Of = std::same_as<std::remove_const_t<M>, T>;

template <Of<core::Pose> M, class V>
void fields(M& m, V&& v) {
  v("position", m.position);
  v("orientation", m.orientation);
}
template <Of<core::LidarModel> M, class V>
void fields(M& m, V&& v) {
  v("name", m.name);
  v("columns", m.columns);
  v("elevation_rad", m.elevation_rad);
  v("min_range_m", m.min_range_m);
  v("max_range_m", m.max_range_m);
  v("period", m.period);
  v("T_body_lidar", m.T_body_lidar);
  v("azimuth_offset_rad", m.azimuth_offset_rad);
  v("beam_origin_m", m.beam_origin_m);
}
template <Of<core::CameraModel> M, class V>
void fields(M& m, V&& v) {
  v("name", m.name);
  v("width", m.width);
  v("height", m.height);
  v("horizontal_fov_rad", m.horizontal_fov_rad);
  v("vertical_fov_rad", m.vertical_fov_rad);
  v("min_range_m", m.min_range_m);
  v("max_range_m", m.max_range_m);
  v("period", m.period);
  v("T_body_camera", m.T_body_camera);
}
template <Of<core::RgbCameraModel> M, class V>
void fields(M& m, V&& v) {
  v("camera", m.camera);
  v("max_incidence_rad", m.max_incidence_rad);
}
template <Of<core::VehicleDescription> M, class V>
void fields(M& m, V&& v) {
  v("name", m.name);
  v("radius_m", m.radius_m);
  v("mass_kg", m.mass_kg);
  v("max_thrust_n", m.max_thrust_n);
  v("max_body_rate_radps", m.max_body_rate_radps);
  v("lidar", m.lidar);
  v("cameras", m.cameras);
  v("rgb", m.rgb);
  v("pose_sensor", m.pose_sensor);
  v("detects_objects", m.detects_objects);
  v("authority", m.authority);
  v("T_world_start", m.T_world_start);
}
template <Of<core::VehicleCheck> M, class V>
void fields(M& m, V&& v) {
  v("name", m.name);
  v("required", m.required);
  v("found", m.found);
  v("holds", m.holds);
}
template <Of<core::AttitudeRateCommand> M, class V>
void fields(M& m, V&& v) {
  v("body_rate_radps", m.body_rate_radps);
  v("thrust_n", m.thrust_n);
  v("armed", m.armed);
}
template <Of<core::Reference> M, class V>
void fields(M& m, V&& v) {
  v("stamp", m.stamp);
  v("position", m.position);
  v("velocity_mps", m.velocity_mps);
  v("acceleration_mps2", m.acceleration_mps2);
  v("jerk_mps3", m.jerk_mps3);
  v("heading_rad", m.heading_rad);
  v("heading_rate_radps", m.heading_rate_radps);
}
template <Of<core::State> M, class V>
void fields(M& m, V&& v) {
  v("stamp", m.stamp);
  v("position", m.position);
  v("velocity_mps", m.velocity_mps);
  v("orientation", m.orientation);
  v("body_rate_radps", m.body_rate_radps);
}
template <Of<core::ObjectDetection> M, class V>
void fields(M& m, V&& v) {
  v("kind", m.kind);
  v("direction", m.direction);
  v("range_m", m.range_m);
  v("bearing_sigma_rad", m.bearing_sigma_rad);
  v("range_sigma_m", m.range_sigma_m);
  v("confidence", m.confidence);
}

// From the core.
template <Of<Hello> M, class V>
void fields(M& m, V&& v) {
  v("magic", m.magic);
  v("version", m.version);
  v("clock", m.clock);
  v("seed", m.seed);
  v("climb_m", m.climb_m);
  v("client", m.client);
}
template <Of<Start> M, class V>
void fields(M&, V&&) {}
template <Of<Run> M, class V>
void fields(M& m, V&& v) {
  v("slot", m.slot);
  v("time", m.time);
}
template <Of<Resume> M, class V>
void fields(M&, V&&) {}
template <Of<core::Command> M, class V>
void fields(M& m, V&& v) {
  v("rates", m.rates);
  v("reference", m.reference);
  v("state", m.state);
  v("state_is_known", m.state_is_known);
}
template <Of<Ping> M, class V>
void fields(M& m, V&& v) {
  v("sent", m.sent);
}
template <Of<Bye> M, class V>
void fields(M& m, V&& v) {
  v("reason", m.reason);
}

// From the vehicle.
template <Of<Welcome> M, class V>
void fields(M& m, V&& v) {
  v("magic", m.magic);
  v("version", m.version);
  v("lockstep", m.lockstep);
  v("real_time", m.real_time);
  v("description", m.description);
}
template <Of<Refuse> M, class V>
void fields(M& m, V&& v) {
  v("reason", m.reason);
}
template <Of<Checks> M, class V>
void fields(M& m, V&& v) {
  v("checks", m.checks);
}
template <Of<Schedule> M, class V>
void fields(M& m, V&& v) {
  v("slot", m.slot);
  v("due", m.due);
  v("period", m.period);
}
template <Of<Pause> M, class V>
void fields(M&, V&&) {}
template <Of<Done> M, class V>
void fields(M& m, V&& v) {
  v("time", m.time);
}
template <Of<Pong> M, class V>
void fields(M& m, V&& v) {
  v("ping_sent", m.ping_sent);
  v("received", m.received);
  v("sent", m.sent);
}
template <Of<core::ImuSample> M, class V>
void fields(M& m, V&& v) {
  v("stamp", m.stamp);
  v("specific_force_mps2", m.specific_force_mps2);
  v("body_rate_radps", m.body_rate_radps);
}
template <Of<core::MagnetometerSample> M, class V>
void fields(M& m, V&& v) {
  v("stamp", m.stamp);
  v("field_ut", m.field_ut);
}
template <Of<core::BarometerSample> M, class V>
void fields(M& m, V&& v) {
  v("stamp", m.stamp);
  v("height_m", m.height_m);
}
template <Of<core::PoseSample> M, class V>
void fields(M& m, V&& v) {
  v("stamp", m.stamp);
  v("T_world_body", m.T_world_body);
}
template <Of<core::BatteryStatus> M, class V>
void fields(M& m, V&& v) {
  v("stamp", m.stamp);
  v("energy_left_wh", m.energy_left_wh);
  v("fraction_left", m.fraction_left);
  v("power_w", m.power_w);
  v("seconds_left", m.seconds_left);
}
template <Of<core::LidarScan> M, class V>
void fields(M& m, V&& v) {
  v("stamp", m.stamp);
  v("range_m", m.range_m);
  v("intensity", m.intensity);
  v("time_s", m.time_s);
  v("direction", m.direction);
}
template <class M, class V>
requires Of<M, Depth> || Of<M, DepthView>
void fields(M& m, V&& v) {
  v("camera", m.camera);
  v("stamp", m.image.stamp);
  v("range_m", m.image.range_m);
}
template <Of<core::RgbFrame> M, class V>
void fields(M& m, V&& v) {
  v("stamp", m.stamp);
  v("rgb", m.rgb);
}
template <Of<Objects> M, class V>
void fields(M& m, V&& v) {
  v("camera", m.camera);
  v("stamp", m.look.stamp);
  v("found", m.look.found);
}
template <Of<Ground> M, class V>
void fields(M& m, V&& v) {
  v("stamp", m.stamp);
}
template <Of<LiftOff> M, class V>
void fields(M& m, V&& v) {
  v("stamp", m.stamp);
}
template <Of<AuthorityChange> M, class V>
void fields(M& m, V&& v) {
  v("stamp", m.stamp);
  v("who", m.who);
  v("reason", m.reason);
}
template <Of<Lost> M, class V>
void fields(M& m, V&& v) {
  v("stamp", m.stamp);
  v("outcome", m.outcome);
  v("reason", m.reason);
}

}  // namespace karst::socket
