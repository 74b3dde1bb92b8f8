// Height by air pressure: coarse, and it drifts with the weather and the sensor's warmth, but no smooth shaft
// can fool it.
#pragma once
#include "core_stack/common/options.h"
#include "core_stack/common/random.h"
#include "core_stack/vehicle/messages.h"

namespace karst::sim {

/// Defaults: a unit such as the MS5611 or BMP388, whose data sheets state 0.08 to 0.12 m of noise, behind a
/// foam in a rotor's wash; its reading wanders by half a metre in five minutes.
struct BarometerOptions {
  double noise_m = 0.12;  // standard deviation of a sample
  double walk_m = 0.03;   // a square root of a second
};
void describe(core::OptionTable& t, BarometerOptions& o);

class Barometer {
 public:
  Barometer(const BarometerOptions& o, core::Random random) : options_(o), random_(random) {}
  /// `dt_s` after the last sample.
  core::BarometerSample sample(core::TimeNs stamp, double height_m, double dt_s);

 private:
  BarometerOptions options_;
  core::Random random_;
  double drift_m_ = 0;
};

}  // namespace karst::sim
