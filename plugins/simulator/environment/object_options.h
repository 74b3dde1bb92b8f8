// The mission file's section `simulator.objects`: the objects to find, and how well they are recognized.
#pragma once
#include "core_stack/common/options.h"

namespace karst::sim {

enum class PlacedOn { floor, rock };
constexpr auto names_of(PlacedOn) {
  using enum PlacedOn;
  return std::to_array<core::Named<PlacedOn>>({{floor, "floor"}, {rock, "rock"}});
}

struct ObjectOptions {
  std::int64_t count = 0;
  PlacedOn on = PlacedOn::floor;
  double range_m = 5, max_incidence_rad = 1.2217305;
  double detection = 0.9, false_per_min = 1;
  double bearing_noise_rad = 0.0174533, depth_noise = 0.02, size_noise = 0.15;
  double delay_s = 0.15;
};
void describe(core::OptionTable& t, ObjectOptions& o);

}  // namespace karst::sim
