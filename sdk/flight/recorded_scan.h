// Scans of a flight as `karst replay` reads them (docs/replay.md).
#pragma once
#include <string>

#include "core_stack/vehicle/messages.h"

namespace karst::flight {

/// When the sweep began: the time of its stamp less a period.
core::TimeNs sweep_begin(const core::LidarScan& scan);

/// The returns as a PCD file (version 0.7, binary): x y z intensity (float32; LiDAR frame, metres; 0..1), t
/// (uint32, ns since the sweep began) and, if the LiDAR has rings, ring (uint16). "" for a scan that does not
/// fit its model.
std::string pcd_of(const core::LidarScan& scan);

/// recording.info of a folder of such files, named by sweep_begin() in nanoseconds, with imu.csv beside them.
std::string recording_info_of(const core::LidarModel& lidar);

}  // namespace karst::flight
