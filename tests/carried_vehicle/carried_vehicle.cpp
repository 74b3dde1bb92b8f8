#include "tests/carried_vehicle/carried_vehicle.h"

#include <cmath>
#include <numbers>

#include "core_stack/common/so3.h"

namespace karst::test {

using core::kMillisecond;
using core::kSecond;
using core::Random;
using core::TimeNs;
using core::Vec3;

namespace {

constexpr TimeNs kTick = 5 * kMillisecond;
constexpr double kRadius_m = 0.3, kGravity_mps2 = 9.81;

sim::LidarOptions lidar_options(const CarriedOptions& o) {
  sim::LidarOptions lidar;
  if (o.fault == PlantedFault::lidar_slow) lidar.rate_hz = 5;
  return lidar;
}

/// The model as described; the fault is that the LiDAR is mounted otherwise.
std::shared_ptr<const core::LidarModel> claimed_model(const CarriedOptions& o,
                                                      const core::LidarModel& true_model) {
  auto claimed = std::make_shared<core::LidarModel>(true_model);
  constexpr double kDegree = std::numbers::pi / 180;
  Vec3 error = Vec3::Zero();
  if (o.fault == PlantedFault::lidar_rolled) error.x() = 3 * kDegree;
  if (o.fault == PlantedFault::lidar_pitched) error.y() = 3 * kDegree;
  if (o.fault == PlantedFault::lidar_yawed) error.z() = 3 * kDegree;
  if (o.fault == PlantedFault::lidar_right_angle) error.z() = 90 * kDegree;
  claimed->T_body_lidar.orientation = core::exp_so3(error) * true_model.T_body_lidar.orientation;
  return claimed;
}

/// Columns of the scan, by the fraction of the turn.
void cover(core::LidarScan& scan, double from, double to, float range_m) {
  const int columns = scan.model->columns;
  for (int c = 0; c < scan.model->channels(); ++c)
    for (int j = static_cast<int>(from * columns); j < static_cast<int>(to * columns); ++j) {
      scan.range_m[static_cast<std::size_t>(c * columns + j)] = range_m;
      scan.intensity[static_cast<std::size_t>(c * columns + j)] = 0;
    }
}

void make_dirty(core::LidarScan& scan, Random random) {
  for (std::size_t i = 0; i < scan.range_m.size(); ++i) {
    scan.range_m[i] += static_cast<float>(0.1 * random.normal());
    scan.intensity[i] *= 0.05f;
    if (random.uniform() < 0.33) scan.range_m[i] = std::numeric_limits<float>::quiet_NaN();
  }
}

}  // namespace

void describe(core::OptionTable& t, CarriedOptions& o) {
  t.add("lifted_after", o.lifted_after_s, "s", 0, 3600, "when it is taken into the hand");
  t.add("fault", o.fault, "the fault that is planted");
}

CarriedVehicle::CarriedVehicle(const CarriedOptions& o, const core::VehicleSetup& setup)
    : options_(o),
      seed_(setup.seed),
      cave_(cave::load_cave(setup.cave, setup.start, setup.mesh)),
      site_(sim::set_down(cave_, kRadius_m)),
      motion_(site_.T_world_start, core::from_seconds(o.lifted_after_s), Random::stream(setup.seed, "hand")),
      lidar_(lidar_options(o)),
      camera_({}, sim::camera_model({}, sim::Facing::up)),
      imu_({}, Random::stream(setup.seed, "imu")),
      magnetometer_random_(Random::stream(setup.seed, "magnetometer")),
      barometer_({}, Random::stream(setup.seed, "barometer")),
      claimed_(claimed_model(o, *lidar_.model())) {
  if (has(PlantedFault::no_room_above))  // after it was set down: otherwise it would stand on that rock
    cave_ = {cave_.description,
             cave_.scene.with_boulders({{site_.T_world_start.position + Vec3(0, 0, 1.3), 0.4}})};
  if (has(PlantedFault::lidar_slow)) {  // described as if it were as fast as it should be
    auto model = std::make_shared<core::LidarModel>(*claimed_);
    model->period = 100 * kMillisecond;
    claimed_ = model;
  }
  description_.name = "carried";
  description_.radius_m = kRadius_m;
  description_.lidar = claimed_;
  description_.cameras = {camera_.model()};
  description_.T_world_start = site_.T_world_start;
}

Random CarriedVehicle::random_at(const char* purpose) const {
  return Random::stream(seed_, std::string(purpose) + " at " + std::to_string(now()));
}

void CarriedVehicle::start(core::Executive& executive, core::VehicleSink& sink) {
  executive_ = &executive;
  sink_ = &sink;
  append(track_, {now(), motion_.at(now())}, now());
  executive.at(now(), [this] { sink_->on_ground(now()); });
  executive.every("carried", now() + kTick, kTick, [this] { tick(); });
}

std::vector<core::VehicleCheck> CarriedVehicle::checks() const {
  const bool wrong = has(PlantedFault::parameter_wrong);
  return {{"COM_OF_LOSS_T", "at most 1 s", wrong ? "5 s" : "1 s", !wrong},
          {"heartbeat", "at least 0.9 Hz", "1 Hz", true}};
}

void CarriedVehicle::by_link(std::function<void()> send) {
  if (!has(PlantedFault::link_slow)) return send();
  executive_->at(now() + 300 * kMillisecond, std::move(send));
}

void CarriedVehicle::tick() {
  append(track_, {now(), motion_.at(now())}, now() - 400 * kMillisecond);
  sense_imu();
  const auto due = [this](TimeNs period) { return now() % period == 0; };
  if (due(20 * kMillisecond) && !has(PlantedFault::compass_missing)) {
    core::MagnetometerSample s =
        sim::measure_field({}, cave_.description.ore_bodies, motion_.at(now()), now(), magnetometer_random_);
    if (has(PlantedFault::compass_turned)) s.field_ut = Vec3(-s.field_ut.y(), s.field_ut.x(), s.field_ut.z());
    by_link([this, s] { sink_->on_magnetometer(s); });
  }
  if (due(40 * kMillisecond)) {
    const double height_m = motion_.at(now()).position.z() - site_.T_world_start.position.z();
    core::BarometerSample s = barometer_.sample(now(), height_m, 0.04);
    if (has(PlantedFault::barometer_stuck)) s.height_m = 0.31;
    by_link([this, s] { sink_->on_barometer(s); });
  }
  if (due(kSecond / 2)) {
    const double fraction = has(PlantedFault::battery_low) ? 0.3 : 0.98;
    const core::BatteryStatus s{now(), 50 * fraction, fraction, 30, 600 * fraction};
    by_link([this, s] { sink_->on_battery(s); });
  }
  if (due(lidar_.model()->period)) fire_lidar();
  if (due(200 * kMillisecond)) {
    auto image = std::make_shared<core::DepthImage>(
        camera_.image(cave_, motion_.at(now()), now(), random_at("camera")));
    executive_->at(now() + 10 * kMillisecond, [this, image] { sink_->on_depth(image); });
  }
}

/// As the simulated vehicle's: means over a tick, by differences of the motion.
void CarriedVehicle::sense_imu() {
  const double dt_s = core::seconds(kTick);
  const core::Pose before = motion_.at(now() - kTick), here = motion_.at(now());
  const core::Pose middle = motion_.at(now() - kTick / 2);
  const Vec3 acceleration = (here.position - 2 * middle.position + before.position) / (dt_s * dt_s / 4);
  Vec3 force = middle.orientation.conjugate() * (acceleration + Vec3(0, 0, kGravity_mps2));
  Vec3 rate = core::log_so3(before.orientation.conjugate() * here.orientation) / dt_s;
  core::ImuSample s = imu_.sample(now(), force, rate, dt_s);
  if (has(PlantedFault::imu_upside_down))
    for (Vec3* v : {&s.specific_force_mps2, &s.body_rate_radps}) *v = Vec3(v->x(), -v->y(), -v->z());
  if (has(PlantedFault::gyro_swapped)) std::swap(s.body_rate_radps.x(), s.body_rate_radps.y());
  if (has(PlantedFault::gyro_scaled)) s.body_rate_radps *= 1.2;
  if (has(PlantedFault::accelerometer_scaled)) s.specific_force_mps2 *= 1.05;
  if (has(PlantedFault::imu_half_rate) && now() % (2 * kTick) != 0) return;
  if (has(PlantedFault::imu_gap) && now() > 3 * kSecond && now() < 3300 * kMillisecond) return;
  by_link([this, s] { sink_->on_imu(s); });
}

void CarriedVehicle::fire_lidar() { deliver(lidar_.sweep(cave_, track_, now(), random_at("lidar"))); }

void CarriedVehicle::deliver(core::LidarScan scan) {
  TimeNs latency = 20 * kMillisecond;
  if (has(PlantedFault::lidar_late)) {
    scan.stamp += 200 * kMillisecond;
    latency += 200 * kMillisecond;
  }
  if (has(PlantedFault::lidar_ahead)) scan.stamp += 200 * kMillisecond;
  if (has(PlantedFault::lidar_clock_jumps) && now() > core::from_seconds(options_.lifted_after_s / 2))
    scan.stamp -= 400 * kMillisecond;
  if (has(PlantedFault::lidar_covered))
    cover(scan, 0.3, 0.3 + 40 / 360.0, std::numeric_limits<float>::quiet_NaN());
  if (has(PlantedFault::lidar_sees_hull)) cover(scan, 0.6, 0.6 + 40 / 360.0, 0.32f);
  if (has(PlantedFault::lidar_dirty)) make_dirty(scan, random_at("dirt"));
  scan.model = claimed_;
  const auto sent = std::make_shared<const core::LidarScan>(std::move(scan));
  executive_->at(now() + latency, [this, sent] { sink_->on_lidar(sent); });
}

}  // namespace karst::test
