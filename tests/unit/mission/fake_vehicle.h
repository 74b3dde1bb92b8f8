// A vehicle for tests of mission control that needs no simulator: a point that turns and is pushed just as it
// is commanded, in rooms drawn with boxes. Its sensors measure without error.
#pragma once
#include <algorithm>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "core_stack/common/so3.h"
#include "core_stack/vehicle/vehicle.h"

namespace karst::core {

/// Free space; where two rooms overlap, one leads into the other. All else is rock.
struct Room {
  Vec3 low, high;
  bool holds(const Vec3& p) const {
    return (p.array() >= low.array()).all() && (p.array() <= high.array()).all();
  }
};

/// Along a ray that begins in one of the rooms, the distance to rock.
inline double range_to_rock_m(const std::vector<Room>& rooms, const Vec3& from, const Vec3& direction) {
  constexpr double kStep_m = 1e-6;  // beyond the wall of a room, to see whether another begins there
  double range_m = 0;
  for (bool goes_on = true; std::exchange(goes_on, false);)
    for (const Room& room : rooms) {
      if (!room.holds(from + (range_m + kStep_m) * direction)) continue;
      double wall_m = std::numeric_limits<double>::infinity();
      for (int axis = 0; axis < 3; ++axis)
        if (direction[axis] != 0)
          wall_m = std::min(
              wall_m, ((direction[axis] > 0 ? room.high : room.low)[axis] - from[axis]) / direction[axis]);
      range_m = wall_m;
      goes_on = true;
    }
  return range_m;
}

class FakeVehicle final : public Vehicle {
 public:
  /// Stands at `start`, which is where the ground is.
  FakeVehicle(std::vector<Room> rooms, const Vec3& start) : rooms_(std::move(rooms)) {
    pose_.position = description_.T_world_start.position = start;
    description_.name = "fake";
    description_.pose_sensor = true;
    auto lidar = std::make_shared<LidarModel>();
    lidar->columns = 90;
    for (int degrees = 80; degrees >= -80; degrees -= 8)
      lidar->elevation_rad.push_back(static_cast<float>(degrees * std::numbers::pi / 180));
    lidar->period = kMillisecond;  // it sees all around at once
    description_.lidar = std::move(lidar);
  }

  // What a test may change in flight.
  bool imu_works = true, pose_sensor_works = true, lidar_works = true, battery_speaks = true;
  double battery_s = 120;                          // left now
  double load_kg = 0;                              // that the description does not know of
  Vec3 wind_push_mps2 = Vec3::Zero();              // world frame
  std::optional<AttitudeRateCommand> pilot_rates;  // in place of the core's
  std::vector<VehicleCheck> checked;

  const Pose& pose() const { return pose_; }
  const Vec3& velocity_mps() const { return velocity_mps_; }
  const AttitudeRateCommand& commanded() const { return command_; }

  VehicleDescription description() const override { return description_; }
  void command(const Command& command) override {
    if (!pilot_rates) command_ = command.rates;
    told_ = command;
  }
  const Command& told() const { return told_; }
  std::vector<VehicleCheck> checks() const override { return checked; }
  void steered_by(Authority who) { description_.authority = who; }
  void start(Executive& executive, VehicleSink& sink) override {
    executive.at(0, [&sink] { sink.on_ground(0); });
    executive.every("vehicle", kTick, kTick, [this, &executive, &sink] {
      if (!crashed_) tick(executive.now(), sink);
    });
  }

 private:
  static constexpr TimeNs kTick = 5 * kMillisecond;
  static constexpr double kGravity_mps2 = 9.81;

  double mass_kg() const { return description_.mass_kg + load_kg; }

  void tick(TimeNs now, VehicleSink& sink) {
    const Vec3 specific_force = move(now, sink);
    battery_s -= seconds(kTick);
    const Vec3 rate = standing_ ? Vec3(Vec3::Zero()) : command_.body_rate_radps;
    if (imu_works) sink.on_imu({now, specific_force, rate});
    if (pose_sensor_works && now % (50 * kMillisecond) == 0) sink.on_pose({now, pose_});
    if (lidar_works && now % (200 * kMillisecond) == 0) sink.on_lidar(scan(now));
    if (battery_speaks && now % (500 * kMillisecond) == 0) {
      BatteryStatus battery;
      battery.stamp = now;
      battery.seconds_left = battery_s;
      sink.on_battery(battery);
    }
  }

  /// Returns the specific force in the body frame.
  Vec3 move(TimeNs now, VehicleSink& sink) {
    if (pilot_rates) command_ = *pilot_rates;
    const double dt_s = seconds(kTick), thrust_n = command_.armed ? command_.thrust_n : 0;
    if (standing_ && thrust_n <= mass_kg() * kGravity_mps2) return {0, 0, kGravity_mps2};
    if (std::exchange(standing_, false)) sink.on_lift_off(now);
    const Quat before = pose_.orientation;
    pose_.orientation = (before * exp_so3(command_.body_rate_radps * dt_s)).normalized();
    const Vec3 force_mps2 =
        before.slerp(0.5, pose_.orientation) * Vec3(0, 0, thrust_n / mass_kg()) + wind_push_mps2;
    const Vec3 acceleration_mps2 = force_mps2 - Vec3(0, 0, kGravity_mps2);
    pose_.position += velocity_mps_ * dt_s + acceleration_mps2 * dt_s * dt_s / 2;
    velocity_mps_ += acceleration_mps2 * dt_s;
    touch(now, sink);
    return pose_.orientation.conjugate() * force_mps2;
  }

  void touch(TimeNs now, VehicleSink& sink) {
    const double ground_m = description_.T_world_start.position.z();
    if (pose_.position.z() < ground_m && velocity_mps_.z() < 0) {
      pose_.position.z() = ground_m;
      pose_.orientation = from_heading(heading_of(pose_.orientation));
      velocity_mps_.setZero();
      standing_ = true;
      sink.on_ground(now);
    }
    for (const Vec3& direction :
         {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 1)})
      crashed_ = crashed_ || range_to_rock_m(rooms_, pose_.position, direction) < description_.radius_m;
    if (crashed_) sink.on_lost(now, MissionOutcome::contact, "touched rock");
  }

  std::shared_ptr<const LidarScan> scan(TimeNs now) const {
    auto scan = std::make_shared<LidarScan>();
    scan->stamp = now;
    scan->model = description_.lidar;
    for (int channel = 0; channel < scan->model->channels(); ++channel)
      for (int column = 0; column < scan->model->columns; ++column) {
        const Vec3 beam = pose_.orientation * scan->model->direction(channel, column).cast<double>();
        scan->range_m.push_back(static_cast<float>(range_to_rock_m(rooms_, pose_.position, beam)));
        scan->intensity.push_back(0.5f);
      }
    return scan;
  }

  std::vector<Room> rooms_;
  VehicleDescription description_;
  AttitudeRateCommand command_;
  Command told_;
  Pose pose_;
  Vec3 velocity_mps_ = Vec3::Zero();
  bool standing_ = true, crashed_ = false;
};

}  // namespace karst::core
