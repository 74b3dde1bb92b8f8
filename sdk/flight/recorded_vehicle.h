// A vehicle whose sensors are recorded into the folder scans of the run directory: the option record.scans.
#pragma once
#include <memory>
#include <mutex>
#include <string>

#include "core_stack/mission/recording/recorder.h"
#include "core_stack/vehicle/vehicle.h"

namespace karst::flight {

/// The first of several problems, whichever thread meets it.
class FirstProblem {
 public:
  void note(const std::string& problem) {
    const std::lock_guard lock(mutex_);
    if (text_.empty()) text_ = problem;
  }
  std::string text() const {  // "" if there was none
    const std::lock_guard lock(mutex_);
    return text_;
  }

 private:
  mutable std::mutex mutex_;
  std::string text_;
};

/// Passes everything on, unchanged and at the same time, and writes what the sensors say: in real time by the
/// recorder's disk thread. Scans are encoded in jobs of the pictures' lane, as the loop must not wait for
/// them. Throws core::InputError where the folder cannot be made, and in finish() if the recording is not
/// complete.
class RecordedVehicle : public core::Vehicle, private core::VehicleSink {
 public:
  /// Both outlive it.
  RecordedVehicle(core::Vehicle& vehicle, core::Recorder& recorder);

  core::VehicleDescription description() const override { return vehicle_.description(); }
  void start(core::Executive& executive, core::VehicleSink& sink) override;
  void command(const core::Command& command) override { vehicle_.command(command); }
  std::vector<core::VehicleCheck> checks() const override { return vehicle_.checks(); }
  void finish() override;

 private:
  void on_lidar(std::shared_ptr<const core::LidarScan> scan) override;
  void on_imu(const core::ImuSample& s) override;
  void on_magnetometer(const core::MagnetometerSample& s) override;
  void on_barometer(const core::BarometerSample& s) override;
  void on_depth(std::shared_ptr<const core::DepthImage> image) override { sink_->on_depth(std::move(image)); }
  void on_rgb(const std::shared_ptr<const core::RgbFrame>& frame) override { sink_->on_rgb(frame); }
  void on_objects(const core::ObjectDetections& look) override { sink_->on_objects(look); }
  void on_pose(const core::PoseSample& s) override { sink_->on_pose(s); }
  void on_battery(const core::BatteryStatus& s) override { sink_->on_battery(s); }
  void on_ground(core::TimeNs stamp) override { sink_->on_ground(stamp); }
  void on_lift_off(core::TimeNs stamp) override { sink_->on_lift_off(stamp); }
  void on_authority(core::TimeNs stamp, core::Authority who, const std::string& why) override {
    sink_->on_authority(stamp, who, why);
  }
  void on_gap() override { sink_->on_gap(); }
  void on_lost(core::TimeNs stamp, core::MissionOutcome outcome, const std::string& reason) override {
    sink_->on_lost(stamp, outcome, reason);
  }

  void record(const std::shared_ptr<const core::LidarScan>& scan);
  void check(bool written);

  core::Vehicle& vehicle_;
  core::Executive* executive_ = nullptr;
  core::VehicleSink* sink_ = nullptr;
  core::DiskWriter* const disk_;
  const std::filesystem::path folder_;
  core::RecordFile imu_, compass_, barometer_;
  core::TimeNs last_begin_ = -1;  // of the scan before
  core::TimeNs last_imu_ = -1;
  std::size_t scans_lost_ = 0;
  const std::shared_ptr<FirstProblem> problem_ = std::make_shared<FirstProblem>();
};

}  // namespace karst::flight
