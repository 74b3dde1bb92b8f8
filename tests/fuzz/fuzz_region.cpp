// Bodies of a region: one that is read has a depth everywhere, which changes no faster than the place.
#include <cmath>
#include <cstdlib>

#include "core_stack/common/error.h"
#include "core_stack/mapping/region/region_keys.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using karst::core::Vec3;
  karst::core::RegionKeys keys;
  keys.keep_in.assign(reinterpret_cast<const char*>(data), size);
  try {
    const auto region = karst::core::region_of("fuzz", keys);
    if (!region) return 0;
    double before = region->depth_m({-4, 3, 1});
    for (double x = -4; x < 4; x += 0.25) {
      const double depth = region->depth_m({x, 3, 1});
      if (!(std::abs(depth - before) <= 0.2501)) std::abort();
      before = depth;
    }
  } catch (const karst::core::InputError&) {
  }
  return 0;
}
