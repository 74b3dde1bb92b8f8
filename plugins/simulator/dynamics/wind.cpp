#include "plugins/simulator/dynamics/wind.h"

#include <cmath>

#include "core_stack/common/random_vector.h"

namespace karst::sim {

using core::Vec3;

namespace {

Vec3 deviation(const WindOptions& o) { return o.gust_mps * Vec3(1, 1, 0.5); }

}  // namespace

void describe(core::OptionTable& t, WindOptions& o) {
  t.add("gust", o.gust_mps, "m/s", 0, 10, "standard deviation of each horizontal component of the gusts");
  t.add("gust_duration", o.correlation_s, "s", 0.05, 100, "correlation time of the gusts");
  t.add("draught_east", o.draught_east_mps, "m/s", -15, 15, "steady wind towards east");
  t.add("draught_north", o.draught_north_mps, "m/s", -15, 15, "steady wind towards north");
}

Wind::Wind(const WindOptions& o, core::Random random)
    : options_(o), random_(random), draught_(o.draught_east_mps, o.draught_north_mps, 0) {
  gust_ = deviation(o).cwiseProduct(normal_vector(random_));
}

void Wind::advance(double dt_s) {
  const double keep = std::exp(-dt_s / options_.correlation_s);
  gust_ =
      keep * gust_ + std::sqrt(1 - keep * keep) * deviation(options_).cwiseProduct(normal_vector(random_));
}

}  // namespace karst::sim
