// The scans of a real LiDAR, by its driver.
#pragma once
#include <utility>

#include "plugins/lidar_drivers/scan_receiver.h"
#include "plugins/mavlink/scan_source.h"

namespace karst::mavlink {

class LidarScans final : public ScanSource {
 public:
  explicit LidarScans(std::unique_ptr<lidar::ScanReceiver> receiver) : receiver_(std::move(receiver)) {}

  std::shared_ptr<const core::LidarModel> model() const override { return receiver_->model(); }
  void start(core::Executive& executive, Receiver receive) override {
    constexpr core::TimeNs kStep = 5 * core::kMillisecond;
    executive.every("lidar", executive.now() + kStep, kStep,
                    [this, &executive, receive = std::move(receive)] {
                      for (auto& scan : receiver_->poll(executive.measured_now())) receive(std::move(scan));
                    });
  }

 private:
  std::unique_ptr<lidar::ScanReceiver> receiver_;
};

}  // namespace karst::mavlink
