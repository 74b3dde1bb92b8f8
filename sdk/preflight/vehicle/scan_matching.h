// Orientations by the core's own scan matching, without an IMU: a faulty one must not spoil what it is
// compared with.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "core_stack/localization/loam.h"
#include "sdk/preflight/vehicle/gyro_track.h"

namespace karst::preflight {

/// Of the body, by the mounting that the scans' model claims. Scans that could not be matched are left out.
/// `self_radius_m`: nearer returns are of the vehicle itself.
std::vector<Orientation> match_scans(std::span<const std::shared_ptr<const core::LidarScan>> scans,
                                     double self_radius_m, const core::LoamOptions& options);

}  // namespace karst::preflight
