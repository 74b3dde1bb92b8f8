// Faults that a preflight must find.
#pragma once
#include "core_stack/common/enum_names.h"

namespace karst::test {

enum class PlantedFault {
  none,
  lidar_rolled,       // mounted 3 degrees about x from where the description says
  lidar_pitched,      // about y
  lidar_yawed,        // about z
  lidar_right_angle,  // 90 degrees about z
  lidar_late,         // stamped and sent 200 ms after the sweep
  lidar_ahead,        // its clock is 200 ms ahead
  lidar_slow,         // 5 Hz
  lidar_covered,      // 40 degrees without returns
  lidar_sees_hull,    // 40 degrees of returns at 0.32 m
  lidar_dirty,        // ranges scatter, a third of the returns is missing, and the rest is weak
  lidar_clock_jumps,  // by 400 ms, in the middle of the rest
  imu_half_rate,      // 100 Hz
  imu_gap,            // 0.3 s without a sample
  imu_upside_down,
  gyro_swapped,          // x and y
  gyro_scaled,           // by 1.2
  accelerometer_scaled,  // by 1.05
  compass_turned,        // 90 degrees about z
  compass_missing,
  barometer_stuck,
  battery_low,      // 30 %
  no_room_above,    // rock 0.9 m above the vehicle's centre
  parameter_wrong,  // of the autopilot
  link_slow         // what the autopilot sends comes 300 ms late
};
constexpr auto names_of(PlantedFault) {
  using enum PlantedFault;
  return std::to_array<core::Named<PlantedFault>>({{none, "none"},
                                                   {lidar_rolled, "lidar_rolled"},
                                                   {lidar_pitched, "lidar_pitched"},
                                                   {lidar_yawed, "lidar_yawed"},
                                                   {lidar_right_angle, "lidar_right_angle"},
                                                   {lidar_late, "lidar_late"},
                                                   {lidar_ahead, "lidar_ahead"},
                                                   {lidar_slow, "lidar_slow"},
                                                   {lidar_covered, "lidar_covered"},
                                                   {lidar_sees_hull, "lidar_sees_hull"},
                                                   {lidar_dirty, "lidar_dirty"},
                                                   {lidar_clock_jumps, "lidar_clock_jumps"},
                                                   {imu_half_rate, "imu_half_rate"},
                                                   {imu_gap, "imu_gap"},
                                                   {imu_upside_down, "imu_upside_down"},
                                                   {gyro_swapped, "gyro_swapped"},
                                                   {gyro_scaled, "gyro_scaled"},
                                                   {accelerometer_scaled, "accelerometer_scaled"},
                                                   {compass_turned, "compass_turned"},
                                                   {compass_missing, "compass_missing"},
                                                   {barometer_stuck, "barometer_stuck"},
                                                   {battery_low, "battery_low"},
                                                   {no_room_above, "no_room_above"},
                                                   {parameter_wrong, "parameter_wrong"},
                                                   {link_slow, "link_slow"}});
}

}  // namespace karst::test
