// Orientations by the gyroscope alone.
#pragma once
#include <span>
#include <vector>

#include "core_stack/common/geometry.h"
#include "core_stack/vehicle/messages.h"

namespace karst::preflight {

struct Orientation {
  core::TimeNs stamp = 0;
  core::Quat q = core::Quat::Identity();  // body to a frame that stands still
};

/// The integral of `map` * (rate - bias), from the identity at the first sample on. Samples that are not
/// later than the one before, or not finite, are left out.
std::vector<Orientation> gyro_track(std::span<const core::ImuSample> samples, const core::Vec3& bias_radps,
                                    const Eigen::Matrix3d& map = Eigen::Matrix3d::Identity());

/// The orientation at `t`, at the nearest end outside of the track, which is not empty.
core::Quat orientation_at(std::span<const Orientation> track, core::TimeNs t);

}  // namespace karst::preflight
