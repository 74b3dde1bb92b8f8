#include "plugins/mavlink/sensor_health.h"

#include <string>

namespace karst::mavlink {

std::vector<core::VehicleCheck> health_checks(const std::optional<SysStatus>& status) {
  core::VehicleCheck health{"sensors' health", "all healthy", "", false},
      transmitter{"transmitter", "heard", "", false};
  if (!status) return {health, transmitter};
  const std::uint32_t enabled = status->onboard_control_sensors_enabled,
                      healthy = enabled & status->onboard_control_sensors_health;
  for (const SensorBit& sensor : kSensorBits)
    if ((enabled & sensor.bit) != 0 && (healthy & sensor.bit) == 0)
      health.found += (health.found.empty() ? "unhealthy: " : ", ") + std::string(sensor.name);
  health.holds = health.found.empty();
  if (health.holds) health.found = "all healthy";
  transmitter.holds = (healthy & kTransmitter.bit) != 0;
  transmitter.found = transmitter.holds ? "heard" : "not heard";
  return {health, transmitter};
}

}  // namespace karst::mavlink
