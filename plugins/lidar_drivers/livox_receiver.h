// The scans of a Livox Mid-360.
#pragma once
#include <utility>

#include "plugins/lidar_drivers/livox/frame_assembler.h"
#include "plugins/lidar_drivers/scan_receiver.h"
#include "plugins/lidar_drivers/stamp_source.h"
#include "plugins/lidar_drivers/transport/packet_source.h"

namespace karst::lidar {

class LivoxReceiver final : public ScanReceiver {
 public:
  /// `points` and `imu` bring the packets of the two ports; `imu` may be null. The axes of the IMU are those
  /// of the points.
  LivoxReceiver(const core::Pose& T_body_sensor, std::unique_ptr<PacketSource> points,
                std::unique_ptr<PacketSource> imu, StampSource stamps);

  const std::shared_ptr<const core::LidarModel>& model() const override { return model_; }
  std::vector<std::shared_ptr<const core::LidarScan>> poll(core::TimeNs now) override;
  std::vector<core::ImuSample> take_imu() override { return std::exchange(imu_samples_, {}); }
  PacketCounts counts() const override;

 private:
  void take_imu_packet(PacketView packet);

  std::shared_ptr<const core::LidarModel> model_;
  LivoxFrameAssembler assembler_;
  std::unique_ptr<PacketSource> points_, imu_;
  StampSource stamps_;
  std::vector<core::ImuSample> imu_samples_;
  std::int64_t last_imu_ns_ = -1;
  std::uint64_t foreign_imu_ = 0;
};

}  // namespace karst::lidar
