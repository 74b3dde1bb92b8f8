// Measures how long the vehicle has stayed in one place.
#pragma once
#include "core_stack/common/geometry.h"
#include "core_stack/common/time.h"

namespace karst::core {

class StillWatch {
 public:
  void restart(const Vec3& here, TimeNs now) {
    place_ = here;
    since_ = now;
  }
  /// Restarts the clock only.
  void wait(TimeNs now) { since_ = now; }
  /// How long the vehicle has been within 0.5 m of one place; 0 once it leaves it.
  TimeNs still_for(const Vec3& here, TimeNs now) {
    constexpr double kPlace_m = 0.5;
    if ((here - place_).norm() > kPlace_m) restart(here, now);
    return now - since_;
  }

 private:
  Vec3 place_ = Vec3::Zero();
  TimeNs since_ = 0;
};

}  // namespace karst::core
