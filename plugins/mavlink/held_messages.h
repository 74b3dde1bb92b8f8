// Scans and images reach the computer by another way than the IMU, and sooner. The core estimates its state
// up to the newest IMU sample: what is newer waits until the IMU has caught up, but not for ever.
#pragma once
#include <deque>
#include <functional>
#include <optional>

#include "core_stack/common/time.h"

namespace karst::mavlink {

class HeldMessages {
 public:
  void hold(core::TimeNs stamp, core::TimeNs now, std::function<void()> deliver) {
    held_.push_back({stamp, now, std::move(deliver)});
  }
  /// Delivers, in the order in which they came, what is not newer than the IMU or has waited long enough.
  void release(std::optional<core::TimeNs> imu_stamp, core::TimeNs now) {
    constexpr core::TimeNs kPatience = 300 * core::kMillisecond;
    while (!held_.empty()) {
      const Held& first = held_.front();
      const bool covered = imu_stamp && first.stamp <= *imu_stamp;
      if (!covered && now - first.since < kPatience) return;
      const std::function<void()> deliver = std::move(held_.front().deliver);
      held_.pop_front();
      deliver();
    }
  }

 private:
  struct Held {
    core::TimeNs stamp, since;
    std::function<void()> deliver;
  };
  std::deque<Held> held_;
};

}  // namespace karst::mavlink
