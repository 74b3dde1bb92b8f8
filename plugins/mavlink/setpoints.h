// What the core commands, as messages to the autopilot.
#pragma once
#include "core_stack/vehicle/command.h"
#include "plugins/mavlink/wire/messages.h"

namespace karst::mavlink {

/// Milliseconds since the start, as the messages carry them.
std::uint32_t boot_ms(core::TimeNs time);

/// Body rates and thrust. `thrust_per_n`: normalized thrust over newtons.
SetAttitudeTarget rates_target(const core::AttitudeRateCommand& rates, double thrust_per_n, core::TimeNs now);

/// The reference as it will be in `ahead_s`, when the message arrives.
SetPositionTargetLocalNed position_target(const core::Reference& reference, double ahead_s, core::TimeNs now);

/// The state as external vision: pose in the local frame FRD, velocity in the body frame FRD, the only pair
/// that both firmwares take.
/// `resets`: how often the pose has jumped, modulo 256.
Odometry vision(const core::State& state, std::uint8_t resets = 0);

// Bits of SetAttitudeTarget::type_mask and frames that a receiver needs to know.
constexpr std::uint8_t kIgnoreAttitude = 0x80;
/// MAV_ESTIMATOR_TYPE: PX4 fuses these up to VIO, passes MOCAP (6) elsewhere and rejects LIDAR (7).
constexpr std::uint8_t kVision = 2, kVio = 3;
constexpr std::uint8_t kLocalNed = 1, kBodyFrd = 12, kLocalFrd = 20;

}  // namespace karst::mavlink
