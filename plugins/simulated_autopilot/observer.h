// The autopilot's own estimate of its motion, NED: it integrates its IMU and is corrected by external vision,
// which comes late: each correction is applied to the state of that time and to all since.
#pragma once
#include <boost/circular_buffer.hpp>
#include <optional>

#include "core_stack/common/geometry.h"
#include "core_stack/common/time.h"

namespace karst::sim {

/// Frames: position and velocity NED, attitude FRD to NED, rate FRD.
struct Motion {
  core::TimeNs stamp = 0;
  core::Vec3 position = core::Vec3::Zero(), velocity_mps = core::Vec3::Zero();
  core::Quat attitude = core::Quat::Identity();
  core::Vec3 rate_radps = core::Vec3::Zero();
};

class Observer {
 public:
  void on_imu(core::TimeNs stamp, const core::Vec3& force_frd, const core::Vec3& rate_frd);
  /// `now`: the IMU's newest stamp, from which the age of the vision counts.
  void on_vision(core::TimeNs stamp, const core::Vec3& position, const core::Vec3& velocity_mps,
                 const core::Quat& attitude);

  const Motion& motion() const { return motion_; }
  /// Since the last vision; nothing before the first.
  std::optional<double> without_vision_s() const;
  /// By dead reckoning the position lasts for `lasts_s`.
  bool position_known(double lasts_s) const;

 private:
  void level(const core::Vec3& force_frd);

  Motion motion_;
  core::Vec3 force_bias_ = core::Vec3::Zero(), rate_bias_ = core::Vec3::Zero();
  boost::circular_buffer<Motion> past_{256};  // 1.3 s
  bool started_ = false;
  std::optional<core::TimeNs> vision_at_;
};

}  // namespace karst::sim
