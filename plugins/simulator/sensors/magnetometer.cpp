#include "plugins/simulator/sensors/magnetometer.h"

#include <algorithm>

#include "core_stack/common/random_vector.h"

namespace karst::sim {

using core::Vec3;

void describe(core::OptionTable& t, MagnetometerOptions& o) {
  t.add("north", o.north_ut, "uT", -70, 70, "horizontal component of the earth's field");
  t.add("down", o.down_ut, "uT", -70, 70, "vertical component of the earth's field");
  t.add("noise", o.noise_ut, "uT", 0, 20, "standard deviation of a sample");
}

Vec3 magnetic_field_ut(const MagnetometerOptions& o, const std::vector<cave::OreBody>& ore_bodies,
                       const Vec3& place) {
  constexpr double kMu0Over4Pi = 0.1;  // uT m / A
  Vec3 field(0, o.north_ut, -o.down_ut);
  for (const cave::OreBody& ore : ore_bodies) {
    const Vec3 offset = place - ore.position;
    const double r = std::max(offset.norm(), 0.1);  // inside the ore the dipole is no model
    const Vec3 unit = offset / r;
    field += kMu0Over4Pi * (3 * ore.moment_am2.dot(unit) * unit - ore.moment_am2) / (r * r * r);
  }
  return field;
}

core::MagnetometerSample measure_field(const MagnetometerOptions& o,
                                       const std::vector<cave::OreBody>& ore_bodies,
                                       const core::Pose& T_world_body, core::TimeNs stamp,
                                       core::Random& random) {
  const Vec3 field = magnetic_field_ut(o, ore_bodies, T_world_body.position);
  return {stamp, T_world_body.orientation.conjugate() * field + o.noise_ut * normal_vector(random)};
}

}  // namespace karst::sim
