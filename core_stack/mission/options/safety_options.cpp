#include "core_stack/mission/options/safety_options.h"

namespace karst::core {

void describe(OptionTable& t, SafetyOptions& o) {
  t.add("slow_fraction", o.slow_fraction, "", 0.1, 1,
        "share of motion.max_speed, or of 2 m/s if that is less, while slowed for safety");
  t.add("tracking_slow", o.tracking_slow_m, "m", 0.1, 10, "tracking error at which the vehicle slows down");
  t.add("tracking_brake", o.tracking_brake_m, "m", 0.1, 10, "tracking error at which it brakes to a hover");
  t.add("hull_clearance", o.hull_clearance_m, "m", 0, 1, "it slows down nearer to obstacles than this");
  t.add("blind_brake", o.blind_brake_s, "s", 0.3, 60, "it brakes after this long without a scan or an image");
  t.add("blind_home", o.blind_home_s, "s", 0.3, 600, "it goes home through the known map after this long");
  t.add("degraded_home", o.degraded_home_s, "s", 0, 600,
        "it goes home when the state estimate is degraded for this long");
  t.add("battery_land", o.battery_land_s, "s", 3, 600,
        "with less battery time than this it lands wherever it is");
}

}  // namespace karst::core
