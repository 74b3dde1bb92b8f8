// Gusts and draught in the cave's air.
#pragma once
#include "core_stack/common/options.h"
#include "core_stack/common/random.h"
#include "plugins/simulator/dynamics/rigid_body.h"

namespace karst::sim {

struct WindOptions {
  double gust_mps = 0.5;                               // standard deviation of each component
  double correlation_s = 2.0;                          // how long a gust lasts
  double draught_east_mps = 0, draught_north_mps = 0;  // steady part
};
void describe(core::OptionTable& t, WindOptions& o);

/// Ornstein-Uhlenbeck process for each component; the vertical one is half as strong, because floor and
/// ceiling restrain the air. Steps of any size have the same statistics.
class Wind {
 public:
  Wind(const WindOptions& o, core::Random random);
  void advance(double dt_s);
  core::Vec3 velocity_mps() const { return draught_ + gust_; }

 private:
  WindOptions options_;
  core::Random random_;
  core::Vec3 draught_, gust_;
};

}  // namespace karst::sim
