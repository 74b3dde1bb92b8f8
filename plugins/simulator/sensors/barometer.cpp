#include "plugins/simulator/sensors/barometer.h"

#include <cmath>

namespace karst::sim {

void describe(core::OptionTable& t, BarometerOptions& o) {
  t.add("noise", o.noise_m, "m", 0, 10, "standard deviation of a sample, as height");
  t.add("walk", o.walk_m, "m", 0, 1,
        "standard deviation of the drift after one second; grows with the root of time");
}

core::BarometerSample Barometer::sample(core::TimeNs stamp, double height_m, double dt_s) {
  drift_m_ += options_.walk_m * std::sqrt(dt_s) * random_.normal();
  return {stamp, height_m + drift_m_ + options_.noise_m * random_.normal()};
}

}  // namespace karst::sim
