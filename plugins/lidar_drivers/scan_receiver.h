// Scans of a real LiDAR, from its packets. One call at each step of a vehicle, on the executive's loop
// thread:
//
//   for (auto& scan : receiver->poll(executive.now())) sink.on_lidar(std::move(scan));
#pragma once
#include <memory>
#include <vector>

#include "core_stack/vehicle/messages.h"
#include "plugins/lidar_drivers/packet/packet_counts.h"

namespace karst::lidar {

class ScanReceiver {
 public:
  virtual ~ScanReceiver() = default;
  virtual const std::shared_ptr<const core::LidarModel>& model() const = 0;
  /// Takes in the packets that have come by `now`, mission time, and returns the scans that are complete,
  /// oldest first, with stamps in mission time. Does not wait.
  virtual std::vector<std::shared_ptr<const core::LidarScan>> poll(core::TimeNs now) = 0;
  /// The samples of the sensor's IMU, in the body frame, that the last call of poll took in, oldest first.
  virtual std::vector<core::ImuSample> take_imu() = 0;
  virtual PacketCounts counts() const = 0;
};

}  // namespace karst::lidar
