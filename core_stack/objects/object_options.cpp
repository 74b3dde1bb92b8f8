#include "core_stack/objects/object_options.h"

namespace karst::core {

void describe(OptionTable& t, ObjectOptions& o) {
  t.add("confirm_after", o.confirm_after, 1, 100, "an object counts as found when it was seen so many times");
  t.add("min_confidence", o.min_confidence, "", 0, 1,
        "detections of which the detector is less sure are dropped");
  t.add("spread", o.spread_m, "m", 0.05, 5,
        "deviation, in each axis, that is added when two places are compared: for the object's own size and "
        "what "
        "the pose is off by; objects of one kind nearer than four times this count as one");
  t.add("forget_after", o.forget_after_s, "s", 1, 3600,
        "what was not confirmed is dropped so long after it was last seen");
  t.add("retell_after", o.retell_after_s, "s", 0.5, 3600,
        "an object that is better known by now is told again, but no sooner after it was last told");
}

}  // namespace karst::core
