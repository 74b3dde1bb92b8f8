// The faults of the cave that affect a sensor's message, and their effect on a scan.
#pragma once
#include <string>
#include <vector>

#include "core_stack/vehicle/messages.h"
#include "plugins/simulator/cave/cave.h"

namespace karst::sim {

class SensorFaults {
 public:
  explicit SensorFaults(std::vector<cave::Fault> faults)
      : faults_(std::move(faults)), begun_(faults_.size()) {}

  struct InjectedFaults {
    std::vector<cave::Fault::Kind> kinds;
    std::vector<std::string> begun;  // descriptions of faults that begin with this message
    bool lost() const;
  };
  /// The faults injected into a message measured now; times must not decrease.
  InjectedFaults inject(cave::Fault::Sensor sensor, double t_s);

 private:
  std::vector<cave::Fault> faults_;
  std::vector<bool> begun_;
};

/// Applies a fault to a scan; kinds that do not concern scans do nothing.
void spoil(core::LidarScan& scan, cave::Fault::Kind kind);

}  // namespace karst::sim
