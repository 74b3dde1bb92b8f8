#include "core_stack/homing/landing/landing_options.h"

namespace karst::core {

void describe(OptionTable& t, LandingOptions& o) {
  t.add("ground_margin", o.ground.margin_m, "m", 0, 2, "ground looked at beyond the vehicle's radius");
  t.add("most_slope", o.ground.most_slope_deg, "", 1, 45, "degrees; steeper ground is not landed on");
  t.add("most_step", o.ground.most_step_m, "m", 0.05, 1, "rougher ground is not landed on");
  t.add("most_drop", o.ground.most_drop_m, "m", 0.5, 20, "from where the descent begins to the ground");
  t.section("link", o.link);
  t.add("keep_apart", o.keep_apart_m, "m", 0.5, 50, "from places of other vehicles");
  t.add("passage_reach", o.passage_reach_m, "m", 1, 10, "others must get by within that of a landed one");
}

}  // namespace karst::core
