// Sensor stamps to mission time, by the way the sensor's clock is set.
#pragma once
#include <functional>

#include "core_stack/common/enum_names.h"
#include "plugins/lidar_drivers/packet/sensor_clock.h"

namespace karst::lidar {

/// relative: the sensor's clock is its own; ptp: it is the host's, by PTP or the like.
enum class ClockKind { relative, ptp };
constexpr auto names_of(ClockKind) {
  using enum ClockKind;
  return std::to_array<core::Named<ClockKind>>({{relative, "relative"}, {ptp, "ptp"}});
}

class StampSource {
 public:
  /// `ahead_ns`: sensor's clock minus the host's, when synchronized. `host_clock`: ns, the clock PTP sets.
  StampSource(ClockKind kind, std::int64_t ahead_ns, std::function<std::int64_t()> host_clock)
      : kind_(kind), ahead_ns_(ahead_ns), host_clock_(std::move(host_clock)) {}

  void begin_poll(core::TimeNs now) {
    now_ = now;
    if (kind_ == ClockKind::ptp) host_ns_ = host_clock_();
  }
  void observe(std::int64_t sensor_ns) {
    if (kind_ == ClockKind::relative) clock_.observe(sensor_ns, now_);
  }
  std::optional<core::TimeNs> at(std::int64_t sensor_ns) const {
    if (kind_ == ClockKind::ptp) return synchronized_at(sensor_ns, ahead_ns_, host_ns_, now_);
    return clock_.at(sensor_ns);
  }

 private:
  ClockKind kind_;
  std::int64_t ahead_ns_;
  std::function<std::int64_t()> host_clock_;
  SensorClock clock_;
  core::TimeNs now_ = 0;
  std::int64_t host_ns_ = 0;
};

}  // namespace karst::lidar
