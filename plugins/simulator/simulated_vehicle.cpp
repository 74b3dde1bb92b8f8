#include "plugins/simulator/simulated_vehicle.h"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include "plugins/simulator/cave/preflight.h"
#include "plugins/simulator/environment/object_placing.h"

namespace karst::sim {

using core::kMillisecond;
using core::kSecond;
using core::Lane;
using core::Random;
using core::TimeNs;
using core::Vec3;
using Sensor = cave::Fault::Sensor;

namespace {

constexpr TimeNs kTick = 5 * kMillisecond;  // also the period of the IMU
constexpr int kStepsPerTick = 5;
/// Without a command for so long the autopilot no longer holds the rates of the last one.
constexpr TimeNs kRatesTimeout = 100 * kMillisecond;
constexpr TimeNs kBarometerPeriod = 40 * kMillisecond;
/// In real time, when ray casting or drawing falls behind: measurements beyond this are not taken. In
/// lockstep fewer wait.
constexpr int kMaxWaiting = 8;
constexpr TimeNs kLidarBudget = 20 * kMillisecond, kCameraBudget = 10 * kMillisecond,
                 kPictureBudget = 100 * kMillisecond;

std::shared_ptr<cave::Cave> checked(const SimulatorOptions& o, const cave::Cave& cave) {
  cave::check_start(cave, o.body.radius_m);
  return std::make_shared<cave::Cave>(cave);
}

/// Whole ticks nearest to a rate, at least one.
TimeNs period_of(double rate_hz) {
  return std::max<TimeNs>(1, std::llround(static_cast<double>(kSecond) / rate_hz / kTick)) * kTick;
}

std::vector<std::shared_ptr<const DepthCamera>> mount_cameras(const SimulatorOptions& o) {
  std::vector<Facing> facing;
  if (o.vehicle == VehiclePreset::camera_uav) facing = {Facing::forward};
  if (o.vehicle == VehiclePreset::lidar_uav) facing = {Facing::up, Facing::down};
  std::vector<std::shared_ptr<const DepthCamera>> cameras;
  for (const Facing f : facing)
    cameras.push_back(std::make_shared<const DepthCamera>(o.camera, camera_model(o.camera, f)));
  return cameras;
}

cave::Cave cave_with_objects(const SimulatorOptions& o, const core::VehicleSetup& setup) {
  cave::Cave cave = cave::load_cave(setup.cave, setup.start, setup.mesh);
  place_objects(cave, o.objects, setup.seed);
  return cave;
}

/// Mean rotation rate between two orientations, body frame.
Vec3 mean_rate_radps(const core::Quat& from, const core::Quat& to, double dt_s) {
  core::Quat turn = from.conjugate() * to;
  if (turn.w() < 0) turn.coeffs() *= -1;
  return 2 / dt_s * turn.vec();
}

}  // namespace

SimulatedVehicle::SimulatedVehicle(const SimulatorOptions& options, const core::VehicleSetup& setup)
    : SimulatedVehicle(options, setup, cave_with_objects(options, setup)) {}

SimulatedVehicle::SimulatedVehicle(const SimulatorOptions& options, const core::VehicleSetup& setup,
                                   const cave::Cave& cave, double cave_ahead_s)
    : options_(options),
      seed_(setup.seed),
      cave_ahead_s_(cave_ahead_s),
      cave_(checked(options, cave)),
      rocks_(cave_->description.boulders),
      air_(options.air, cave_->description.clouds, options.body.radius_m),
      faults_(cave_->description.faults),
      site_(set_down(*cave_, options.body.radius_m)),
      quadrotor_({options.body, options.motors, options.autopilot, options.battery}, site_.T_world_start,
                 cave_->scene, Wind(options.wind, Random::stream(setup.seed, "wind"))),
      lidar_(options.vehicle == VehiclePreset::camera_uav ? nullptr
                                                          : std::make_shared<const Lidar>(options.lidar)),
      cameras_(mount_cameras(options)),
      rgb_(options.rgb.fitted ? std::make_shared<const RgbCamera>(options.rgb) : nullptr),
      detector_(options.objects, options.rgb),
      looks_(cave_->description.objects.size(), 0),
      imu_(options.imu, Random::stream(setup.seed, "imu"), Random::stream(setup.seed, "vibration")),
      magnetometer_random_(Random::stream(setup.seed, "magnetometer")),
      barometer_(options.barometer, Random::stream(setup.seed, "barometer")),
      pose_sensor_(options.pose, site_.T_world_start, Random::stream(setup.seed, "pose")),
      log_(setup.run_dir) {
  renew_sight();
  cave::check_climb(*cave_, site_.T_world_start.position, setup.climb_m, options.body.radius_m);
  description_.name = core::name_of(options.vehicle);
  description_.radius_m = options.body.radius_m;
  description_.mass_kg = options.body.mass_kg;
  description_.max_thrust_n = 4 * max_motor_thrust_n(options.motors, options.body);
  description_.max_body_rate_radps = options.autopilot.max_body_rate_radps;
  if (lidar_) description_.lidar = lidar_->model();
  for (const auto& camera : cameras_) description_.cameras.push_back(camera->model());
  if (rgb_) description_.rgb = rgb_->model();
  description_.pose_sensor = options.pose.fitted == PoseSensorFitted::always ||
                             (options.pose.fitted == PoseSensorFitted::without_lidar && !lidar_);
  description_.detects_objects = !looks_.empty() && (rgb_ || !cameras_.empty());
  description_.T_world_start = site_.T_world_start;
}

void SimulatedVehicle::start(core::Executive& executive, core::VehicleSink& sink) {
  executive_ = &executive;
  sink_ = &sink;
  start_time_ = now();
  last_orientation_ = quadrotor_.state().T_world_body.orientation;
  append(track_, {now(), quadrotor_.state().T_world_body}, now());
  schedule_sensors();
  executive.at(now(), [this] {
    log_.event(now(), "start", quadrotor_.state(), site_.pad ? "on a launch pad" : "on the floor");
    for (std::size_t i = 0; i < looks_.size(); ++i)
      log_.object(now(), "placed", i + 1, cave_->description.objects[i]);
    log_truth();
    sink_->on_battery(quadrotor_.battery().status(now()));
    sink_->on_ground(now());
  });
  if (options_.motors.weak > 0)
    executive.at(now() + core::from_seconds(options_.motors.weak_after_s), [this] {
      char text[60];
      std::snprintf(text, sizeof text, "motor %d at %.0f %%", static_cast<int>(options_.motors.weak),
                    100 * options_.motors.weak_fraction);
      log_.event(now(), "fault", quadrotor_.state(), text);
    });
  executive.every("vehicle", now() + kTick, kTick, [this] {
    if (!lost_) tick();
  });
}

/// Sensors are read in the vehicle's own tick, after its motion, so each sees the state of that instant.
void SimulatedVehicle::schedule_sensors() {
  const auto every = [this](TimeNs period, TimeNs phase, std::function<void()> read) {
    schedule_.push_back({period, phase, std::move(read)});
  };
  if (description_.pose_sensor) every(period_of(options_.pose.rate_hz), 0, [this] { report_pose(); });
  every(20 * kMillisecond, 0, [this] {
    const core::MagnetometerSample field =
        measure_field(options_.magnetometer, cave_->description.ore_bodies, quadrotor_.state().T_world_body,
                      now(), magnetometer_random_);
    if (!faults_of(Sensor::magnetometer).lost()) sink_->on_magnetometer(field);
  });
  every(kBarometerPeriod, 0, [this] {
    const double height_m = quadrotor_.state().T_world_body.position.z() - site_.T_world_start.position.z();
    const core::BarometerSample sample = barometer_.sample(now(), height_m, core::seconds(kBarometerPeriod));
    if (!faults_of(Sensor::barometer).lost()) sink_->on_barometer(sample);
  });
  every(kSecond / 2, 0, [this] { sink_->on_battery(quadrotor_.battery().status(now())); });
  if (lidar_) every(lidar_->model()->period, 0, [this] { fire_lidar(); });
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    // Fires between two sweeps, each camera at another phase, so that the sensing lane is loaded evenly.
    const TimeNs period = cameras_[i]->model()->period;
    every(period, static_cast<TimeNs>(i + 1) * 30 * kMillisecond % period, [this, i] { fire_camera(i); });
  }
  if (rgb_) every(rgb_->model()->camera.period, 0, [this] { take_picture(); });
  if (!cave_->description.boulders.empty()) every(20 * kMillisecond, 0, [this] { move_rocks(); });
  every(core::from_seconds(CaveAir::kPuffPeriod_s), 0, [this] { stir_air(); });
  every(10 * kMillisecond, 0, [this] { log_truth(); });
}

void SimulatedVehicle::command(const core::Command& c) {
  quadrotor_.command = c.rates;
  commanded_at_ = executive_ ? now() : 0;
  taken_over_ = false;
  velocity_error_mps_.reset();
  if (c.state_is_known) velocity_error_mps_ = c.state.velocity_mps - quadrotor_.state().velocity_mps;
}

/// The autopilot takes over: it brakes first, and then comes down. Rates that are held for longer would tip
/// it over. A vehicle that stands switches its motors off. For five seconds it knows its velocity by dead
/// reckoning from the last estimate that it was told, as PX4 does (EKF2_NOAID_TOUT): with the estimate's
/// error, and none of its own.
void SimulatedVehicle::take_over() {
  if (!std::exchange(taken_over_, true))
    log_.event(now(), "autopilot", quadrotor_.state(), "no command: brakes, then down");
  constexpr TimeNs kDeadReckoning = 5 * core::kSecond;
  constexpr double kSink_mps = 0.5;
  constexpr TimeNs kHover = 3 * core::kSecond / 2;
  const TimeNs silence = now() - commanded_at_;
  std::optional<Vec3> velocity;
  if (velocity_error_mps_ && silence < kDeadReckoning)
    velocity = quadrotor_.state().velocity_mps + *velocity_error_mps_;
  quadrotor_.command = quadrotor_.footing() == Footing::standing
                           ? core::AttitudeRateCommand{}
                           : level_descent(quadrotor_.state(), options_.body.total_weight_n(), velocity,
                                           silence > kHover ? kSink_mps : 0);
}

void SimulatedVehicle::tick() {
  if (quadrotor_.command.armed && now() - commanded_at_ > kRatesTimeout) take_over();
  quadrotor_.gyroscope_bias_radps = imu_.gyroscope_bias_radps();
  for (int left = kStepsPerTick; left > 0 && !lost_; left -= quadrotor_.steps_done())
    react(quadrotor_.advance(left));
  if (lost_) return;
  if (quadrotor_.battery().empty()) return lose(core::MissionOutcome::battery, "the battery is empty");

  const BodyState& s = quadrotor_.state();
  const double dt_s = core::seconds(kTick);
  const Vec3 acceleration = (s.velocity_mps - last_velocity_mps_) / dt_s;
  const core::Quat midway = last_orientation_.slerp(0.5, s.T_world_body.orientation);
  const Vec3 specific_force = midway.conjugate() * (acceleration + Vec3(0, 0, kGravity_mps2));
  const Vec3 rate = mean_rate_radps(last_orientation_, s.T_world_body.orientation, dt_s);
  last_velocity_mps_ = s.velocity_mps;
  last_orientation_ = s.T_world_body.orientation;
  const TimeNs sweep = lidar_ ? lidar_->model()->period : 0;
  append(track_, {now(), s.T_world_body}, now() - sweep);
  const core::ImuSample sample =
      imu_.sample(now(), specific_force, rate, dt_s, quadrotor_.footing() != Footing::standing);
  if (!faults_of(Sensor::imu).lost()) sink_->on_imu(sample);
  for (const Reading& r : schedule_)
    if (!lost_ && (now() - start_time_) % r.period == r.phase) r.read();
}

void SimulatedVehicle::react(QuadrotorEvent event) {
  const BodyState& s = quadrotor_.state();
  switch (event) {
    case QuadrotorEvent::none:
      return;
    case QuadrotorEvent::take_off:
      log_.event(now(), "take-off", s, "");
      return sink_->on_lift_off(now());
    case QuadrotorEvent::landed:
      log_.event(now(), "landed", s, "");
      return sink_->on_ground(now());
    case QuadrotorEvent::crashed: {
      const Touch& t = *quadrotor_.last_touch();
      char text[200];
      std::snprintf(text, sizeof text,
                    "touched rock at (%.2f %.2f %.2f) at %.2f m/s after %.2f s, %.0f deg from straight down",
                    t.place.x(), t.place.y(), t.place.z(), s.velocity_mps.norm(), core::seconds(now()),
                    angle_from_down_rad(t) * 180 / std::numbers::pi);
      return lose(core::MissionOutcome::contact, text);
    }
  }
}

void SimulatedVehicle::lose(core::MissionOutcome outcome, const std::string& reason) {
  lost_ = true;
  log_truth();
  log_.event(now(), core::name_of(outcome), quadrotor_.state(), reason);
  sink_->on_lost(now(), outcome, reason);
}

Random SimulatedVehicle::measurement_random(const std::string& sensor) {
  return Random::stream(seed_, sensor + " at " + std::to_string(now()));
}

SensorFaults::InjectedFaults SimulatedVehicle::faults_of(Sensor sensor) {
  SensorFaults::InjectedFaults injected = faults_.inject(sensor, core::seconds(now() - start_time_));
  for (const std::string& what : injected.begun) log_.event(now(), "fault", quadrotor_.state(), what);
  return injected;
}

Air SimulatedVehicle::air_for(const std::string& beams) {
  const bool airborne = quadrotor_.footing() != Footing::standing;
  return {air_.present(cave_time_s(), quadrotor_.state().T_world_body.position, airborne),
          measurement_random(beams + " in air")};
}

void SimulatedVehicle::fire_lidar() {
  const SensorFaults::InjectedFaults injected = faults_of(Sensor::lidar);
  if (injected.lost() || executive_->under_way("lidar") >= kMaxWaiting) return;
  auto scan = std::make_shared<core::LidarScan>();
  executive_->job(
      "lidar", Lane::sensing, kLidarBudget,
      [scan, lidar = lidar_, cave = seen_, track = track_, stamp = now(),
       random = measurement_random("lidar"), air = air_for("lidar"), kinds = injected.kinds] {
        *scan = lidar->sweep(*cave, track, stamp, random, air);
        for (const cave::Fault::Kind kind : kinds) spoil(*scan, kind);
      },
      [this, scan] {
        if (!lost_) sink_->on_lidar(scan);
      });
}

void SimulatedVehicle::fire_camera(std::size_t index) {
  if (faults_of(Sensor::camera).lost() || executive_->under_way("depth camera") >= kMaxWaiting) return;
  auto image = std::make_shared<core::DepthImage>();
  const auto& camera = cameras_[index];
  look_for_objects(camera->model(), Light::own);
  const std::string& name = camera->model()->name;
  executive_->job(
      "depth camera", Lane::sensing, kCameraBudget,
      [image, camera, cave = seen_, T = quadrotor_.state().T_world_body, stamp = now(),
       random = measurement_random(name),
       air = air_for(name)] { *image = camera->image(*cave, T, stamp, random, air); },
      [this, image] {
        if (!lost_) sink_->on_depth(image);
      });
}

/// Runs on a separate lane: a picture takes longer than a sweep, and nothing in flight waits for it.
void SimulatedVehicle::take_picture() {
  if (faults_of(Sensor::camera).lost() || executive_->under_way("rgb camera") >= kMaxWaiting) return;
  const core::Pose& T_world_body = quadrotor_.state().T_world_body;
  look_for_objects({rgb_->model(), &rgb_->model()->camera}, Light::lamp);
  log_.picture(now(), T_world_body * rgb_->model()->camera.T_body_camera, *rgb_->model());
  auto frame = std::make_shared<core::RgbFrame>(core::RgbFrame{now(), rgb_->model(), {}});
  const bool draw = rgb_->takes_pictures();
  executive_->job(
      "rgb camera", Lane::pictures, kPictureBudget,
      [frame, draw, rgb = rgb_, cave = seen_, T = T_world_body, random = measurement_random("rgb"),
       air = draw ? air_for("rgb") : Air{}] {
        if (draw) frame->rgb = rgb->picture(*cave, T, random, air);
      },
      [this, frame] {
        if (!lost_) sink_->on_rgb(frame);
      });
}

/// Searches the image that `camera` takes now: logs objects in view as truth, sends detections to the core.
void SimulatedVehicle::look_for_objects(const std::shared_ptr<const core::CameraModel>& camera, Light light) {
  if (!description_.detects_objects) return;
  const core::Pose T_world_camera = quadrotor_.state().T_world_body * camera->T_body_camera;
  const std::string stream = "objects " + camera->name;
  const std::vector<InView> in_view =
      detector_.in_view(*seen_, T_world_camera, *camera, light, air_for(stream).clouds);
  for (const InView& o : in_view) {
    const int looks = ++looks_[o.object];
    if (looks == 1 || looks == kSeenAfter)
      log_.object(now(), looks == 1 ? "in view" : "seen", o.object + 1, cave_->description.objects[o.object]);
  }
  core::ObjectDetections look{now(), camera, {}};
  look.found = detector_.detect(*seen_, T_world_camera, *camera, light, in_view, measurement_random(stream));
  if (look.found.empty()) return;
  executive_->at(now() + core::from_seconds(options_.objects.delay_s), [this, look] {
    if (!lost_) sink_->on_objects(look);
  });
}

void SimulatedVehicle::report_pose() {
  const core::PoseSample sample = pose_sensor_.sample(now(), quadrotor_.state().T_world_body);
  if (faults_of(Sensor::pose).lost()) return;
  executive_->at(now() + core::from_seconds(options_.pose.delay_s), [this, sample] {
    if (!lost_) sink_->on_pose(sample);
  });
}

void SimulatedVehicle::stir_air() {
  if (quadrotor_.footing() == Footing::standing) return;
  air_.stir(cave_time_s(), quadrotor_.state().T_world_body, cave_->scene);
}

/// Scans and images still being computed keep the cave as it was at their stamp.
void SimulatedVehicle::move_rocks() {
  const std::size_t before = cave_->scene.boulders().size();
  if (!rocks_.advance(cave_time_s(), quadrotor_.state().T_world_body.position)) return;
  cave_ = std::make_shared<cave::Cave>(
      cave::Cave{cave_->description, cave_->scene.with_boulders(rocks_.present())});
  renew_sight();
  quadrotor_.put_into(cave_->scene);
  if (const std::size_t there = cave_->scene.boulders().size(); there > before)
    log_.event(now(), "rockfall", quadrotor_.state(), std::to_string(there) + " boulders");
}

void SimulatedVehicle::see(std::vector<cave::Sphere> others) {
  others_ = std::move(others);
  renew_sight();
}

void SimulatedVehicle::renew_sight() {
  seen_ = cave_;
  if (others_.empty()) return;
  std::vector<cave::Sphere> balls = cave_->scene.boulders();
  balls.insert(balls.end(), others_.begin(), others_.end());
  seen_ = std::make_shared<cave::Cave>(
      cave::Cave{cave_->description, cave_->scene.with_boulders(std::move(balls))});
}

void SimulatedVehicle::log_truth() {
  const BodyState& s = quadrotor_.state();
  log_.pose(now(), s.T_world_body);
  if (now() % (50 * kMillisecond) == 0 || lost_) {
    const core::BatteryStatus b = quadrotor_.battery().status(now());
    log_.row(now(), {quadrotor_.clearance_m(), s.velocity_mps.norm(), b.fraction_left, b.power_w,
                     quadrotor_.wind_mps()});
  }
  if (now() % kSecond == 0 || lost_) log_.flush();
}

void SimulatedVehicle::finish() { log_.close(); }

}  // namespace karst::sim
