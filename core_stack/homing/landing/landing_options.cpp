#include "core_stack/homing/landing/landing_options.h"

namespace karst::core {

void describe(OptionTable& t, LandingOptions& o) {
  t.add("ground_margin", o.ground.margin_m, "m", 0, 2, "ground looked at beyond the vehicle's radius");
  t.add("max_slope", o.ground.max_slope_deg, "", 1, 45, "degrees; steeper ground is not landed on");
  t.add("max_step", o.ground.max_step_m, "m", 0.05, 1, "rougher ground is not landed on");
  t.add("max_drop", o.ground.max_drop_m, "m", 0.5, 20, "from where the descent begins to the ground");
  t.section("link", o.link);
  t.add("separation", o.separation_m, "m", 0.5, 50, "from places of other vehicles");
  t.add("passage_radius", o.passage_radius_m, "m", 1, 10, "others must get by within that of a landed one");
}

}  // namespace karst::core
