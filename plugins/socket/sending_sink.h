// Turns what a vehicle delivers into messages for the client, and notes whether the vehicle stands.
#pragma once
#include <functional>

#include "plugins/socket/stream.h"

namespace karst::socket {

class SendingSink final : public core::VehicleSink {
 public:
  /// `pause` is called after a message that the core may answer at once by a command.
  SendingSink(Stream& client, const core::VehicleDescription& vehicle, std::function<void()> pause = {});

  /// Nothing is sent from now on.
  void mute() { muted_ = true; }
  bool muted() const { return muted_; }
  /// Whether the vehicle can no longer fall: it stands, or its flight is over.
  bool down() const { return standing_ || lost_; }

  void on_lidar(std::shared_ptr<const core::LidarScan> scan) override { measured(*scan); }
  void on_depth(std::shared_ptr<const core::DepthImage> image) override {
    measured(DepthView{number_of(image->model.get()), *image});
  }
  void on_rgb(const std::shared_ptr<const core::RgbFrame>& frame) override { measured(*frame); }
  void on_objects(const core::ObjectDetections& look) override {
    measured(Objects{number_of(look.camera.get()), look});
  }
  void on_imu(const core::ImuSample& s) override { measured(s); }
  void on_magnetometer(const core::MagnetometerSample& s) override { measured(s); }
  void on_barometer(const core::BarometerSample& s) override { measured(s); }
  void on_pose(const core::PoseSample& s) override { measured(s); }
  void on_battery(const core::BatteryStatus& s) override { measured(s); }
  void on_ground(core::TimeNs stamp) override {
    standing_ = true;
    tell(Ground{stamp});
  }
  void on_lift_off(core::TimeNs stamp) override {
    standing_ = false;
    tell(LiftOff{stamp});
  }
  void on_authority(core::TimeNs stamp, core::Authority who, const std::string& reason) override {
    tell(AuthorityChange{stamp, who, reason});
  }
  void on_lost(core::TimeNs stamp, core::MissionOutcome outcome, const std::string& reason) override {
    lost_ = true;
    tell(Lost{stamp, outcome, reason});
  }

 private:
  /// A client that takes nothing for long loses measurements, but no change of the vehicle's state.
  template <class M>
  void measured(const M& message) {
    if (!muted_ && (pause_ || client_.backlog_bytes() < kMaxToCoreBytes)) client_.queue(message);
  }
  template <class M>
  void tell(const M& message) {
    if (muted_) return;
    client_.queue(message);
    if (pause_) pause_();
  }
  std::uint16_t number_of(const core::CameraModel* camera) const;

  Stream& client_;
  core::VehicleDescription vehicle_;
  std::function<void()> pause_;
  bool muted_ = false, standing_ = true, lost_ = false;
};

}  // namespace karst::socket
