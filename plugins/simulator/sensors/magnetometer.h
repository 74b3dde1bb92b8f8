// Magnetic field of the earth and of ore bodies.
#pragma once
#include "core_stack/common/options.h"
#include "core_stack/common/random.h"
#include "core_stack/vehicle/messages.h"
#include "plugins/simulator/cave/cave.h"

namespace karst::sim {

struct MagnetometerOptions {
  double north_ut = 20.5, down_ut = 44.5;  // Central Europe
  double noise_ut = 0.3;
};
void describe(core::OptionTable& t, MagnetometerOptions& o);

/// World frame, microtesla: the earth's field plus each ore body's dipole,
/// B = mu0 / (4 pi) (3 (m . r) r - m) / |r|^3 with r the unit vector from the dipole.
core::Vec3 magnetic_field_ut(const MagnetometerOptions& o, const std::vector<cave::OreBody>& ore_bodies,
                             const core::Vec3& place);

core::MagnetometerSample measure_field(const MagnetometerOptions& o,
                                       const std::vector<cave::OreBody>& ore_bodies,
                                       const core::Pose& T_world_body, core::TimeNs stamp,
                                       core::Random& random);

}  // namespace karst::sim
