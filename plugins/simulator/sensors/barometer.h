// Height from air pressure: coarse, and it drifts with the weather and the sensor's temperature, but a smooth
// shaft, where a LiDAR fails, does not affect it.
#pragma once
#include "core_stack/common/options.h"
#include "core_stack/common/random.h"
#include "core_stack/vehicle/messages.h"

namespace karst::sim {

/// Defaults: a unit such as the MS5611 or BMP388, whose data sheets state 0.08 to 0.12 m of noise, behind
/// foam in the rotors' wash; its reading drifts by half a metre in five minutes.
struct BarometerOptions {
  double noise_m = 0.12;  // standard deviation of a sample
  double walk_m = 0.03;   // random walk, per square root of a second
};
void describe(core::OptionTable& t, BarometerOptions& o);

class Barometer {
 public:
  Barometer(const BarometerOptions& o, core::Random random) : options_(o), random_(random) {}
  /// A sample `dt_s` after the last one.
  core::BarometerSample sample(core::TimeNs stamp, double height_m, double dt_s);

 private:
  BarometerOptions options_;
  core::Random random_;
  double drift_m_ = 0;
};

}  // namespace karst::sim
