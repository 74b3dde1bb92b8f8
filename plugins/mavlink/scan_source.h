// Where the scans of a vehicle's LiDAR come from: its own driver, or a simulator.
#pragma once
#include <functional>
#include <memory>

#include "core_stack/common/executive.h"
#include "core_stack/vehicle/messages.h"

namespace karst::mavlink {

class ScanSource {
 public:
  using Receiver = std::function<void(std::shared_ptr<const core::LidarScan>)>;
  virtual ~ScanSource() = default;
  /// Null if the vehicle has no LiDAR.
  virtual std::shared_ptr<const core::LidarModel> model() const = 0;
  /// From now on every scan goes to `receive`, on the loop's thread, stamped in the executive's time.
  virtual void start(core::Executive& executive, Receiver receive) = 0;
};

}  // namespace karst::mavlink
