// The mission file's section `objects`: when detections count as an object.
#pragma once
#include "core_stack/common/options.h"

namespace karst::core {

struct ObjectOptions {
  std::int64_t confirm_after = 3;
  double min_confidence = 0.4;
  double spread_m = 0.25;
  double forget_after_s = 60;
  double retell_after_s = 5;
};
void describe(OptionTable& t, ObjectOptions& o);

}  // namespace karst::core
