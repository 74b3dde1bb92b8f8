// What the autopilot says of its own sensors (SYS_STATUS), for the checks before a flight.
#pragma once
#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "core_stack/vehicle/vehicle.h"
#include "plugins/mavlink/wire/messages.h"

namespace karst::mavlink {

/// A bit of MAV_SYS_STATUS_SENSOR, https://mavlink.io/en/messages/common.html
struct SensorBit {
  std::string_view name;
  std::uint32_t bit;
};
/// Those that need the core's poses, such as the estimate of the attitude, are not among them: before the
/// flight there are no poses.
constexpr std::array<SensorBit, 5> kSensorBits{{{"gyroscope", 0x1},
                                                {"accelerometer", 0x2},
                                                {"magnetometer", 0x4},
                                                {"barometer", 0x8},
                                                {"battery", 0x2000000}}};
constexpr SensorBit kTransmitter{"transmitter", 0x10000};

/// "sensors' health": all that the autopilot uses are healthy. "transmitter": the pilot's is heard, or nobody
/// could take over. `status`: nothing if none came.
std::vector<core::VehicleCheck> health_checks(const std::optional<SysStatus>& status);

}  // namespace karst::mavlink
