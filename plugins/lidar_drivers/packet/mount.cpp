#include "plugins/lidar_drivers/packet/mount.h"

#include <array>
#include <cmath>
#include <sstream>

#include "core_stack/common/error.h"

namespace karst::lidar {

core::Pose mount_of(const std::string& source, const std::string& key, const std::string& text) {
  std::istringstream in(text);
  std::array<double, 6> v{};
  bool good = true;
  for (double& x : v) good = good && static_cast<bool>(in >> x) && std::isfinite(x);
  std::string more;
  if (!good || in >> more)
    throw core::InputError(source, key,
                           "is not \"x y z roll pitch yaw\" in m and degrees, but \"" + text + "\"");
  constexpr double kRadians = std::numbers::pi / 180;
  const core::Quat q = core::Quat(Eigen::AngleAxisd(v[5] * kRadians, core::Vec3::UnitZ())) *
                       Eigen::AngleAxisd(v[4] * kRadians, core::Vec3::UnitY()) *
                       Eigen::AngleAxisd(v[3] * kRadians, core::Vec3::UnitX());
  return {{v[0], v[1], v[2]}, q.normalized()};
}

}  // namespace karst::lidar
