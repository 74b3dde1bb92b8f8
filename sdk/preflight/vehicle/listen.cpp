#include "sdk/preflight/vehicle/listen.h"

#include <algorithm>

namespace karst::preflight {
namespace {

using core::TimeNs;

/// What noise and blocked sectors are found from; more adds nothing but memory.
constexpr std::size_t kScansAtRest = 40, kImages = 10;

class RecordingSink final : public core::VehicleSink {
 public:
  RecordingSink(const core::Executive& executive, VehicleRecord& record)
      : executive_(executive), record_(record) {}
  void on_lidar(std::shared_ptr<const core::LidarScan> s) override {
    record_.lidar_arrivals.push_back(arrival(s->stamp));
    if (in_motion)
      record_.scans_in_motion.push_back(std::move(s));
    else if (record_.scans_at_rest.size() < kScansAtRest)
      record_.scans_at_rest.push_back(std::move(s));
  }
  void on_depth(std::shared_ptr<const core::DepthImage> image) override {
    const auto& cameras = record_.vehicle.cameras;
    const auto camera = std::find(cameras.begin(), cameras.end(), image->model);
    if (camera == cameras.end()) return;
    CameraRecord& record = record_.cameras[static_cast<std::size_t>(camera - cameras.begin())];
    record.arrivals.push_back(arrival(image->stamp));
    if (!in_motion && record.images.size() < kImages) record.images.push_back(std::move(image));
  }
  void on_imu(const core::ImuSample& s) override {
    record_.imu.push_back(s);
    record_.imu_arrivals.push_back(arrival(s.stamp));
  }
  void on_magnetometer(const core::MagnetometerSample& s) override {
    record_.magnetometer.push_back(s);
    record_.magnetometer_arrivals.push_back(arrival(s.stamp));
  }
  void on_barometer(const core::BarometerSample& s) override {
    record_.barometer.push_back(s);
    record_.barometer_arrivals.push_back(arrival(s.stamp));
  }
  void on_pose(const core::PoseSample& s) override { record_.pose_arrivals.push_back(arrival(s.stamp)); }
  void on_battery(const core::BatteryStatus& s) override {
    record_.battery.push_back(s);
    record_.battery_arrivals.push_back(arrival(s.stamp));
  }
  void on_ground(TimeNs) override {}
  void on_lift_off(TimeNs) override {
    if (!in_motion) record_.lifted_off = true;  // by hand it may well leave the ground
  }
  void on_lost(TimeNs, core::MissionOutcome outcome, const std::string& reason) override {
    record_.lost = reason.empty() ? core::name_of(outcome) : reason;
  }

  bool in_motion = false;

 private:
  Arrival arrival(TimeNs stamp) const { return {stamp, executive_.now()}; }

  const core::Executive& executive_;
  VehicleRecord& record_;
};

}  // namespace

VehicleRecord listen(core::Vehicle& vehicle, const ListenOptions& options,
                     const std::atomic<bool>& interrupted) {
  VehicleRecord record;
  record.vehicle = vehicle.description();
  record.cameras.resize(record.vehicle.cameras.size());
  core::Executive executive(1, options.clock);
  RecordingSink sink(executive, record);
  const auto over = [&] { return interrupted || !record.lost.empty(); };
  vehicle.start(executive, sink);
  options.begins(ListenStep::rest);
  executive.run_until(options.rest, over);
  record.rest_end = record.end = executive.now();
  if (options.motion > 0 && !over()) {
    sink.in_motion = true;
    options.begins(ListenStep::motion);
    executive.run_until(options.rest + options.motion, over);
    record.end = executive.now();
  }
  record.checks = vehicle.checks();
  executive.drain();
  vehicle.finish();
  return record;
}

}  // namespace karst::preflight
