#include "core_stack/mapping/region/flight_region.h"

#include <algorithm>

namespace karst::core {

// The distance to the outside of an intersection is the least of the distances to the outside of its parts.
double FlightRegion::depth_m(const Vec3& p) const {
  double depth = std::numeric_limits<double>::infinity();
  if (limits_.keep_in) depth = depth_in(*limits_.keep_in, p);
  for (const Prism& out : limits_.keep_out) depth = std::min(depth, -depth_in(out, p));
  return depth;
}

std::string FlightRegion::nearest_part(const Vec3& p) const {
  const double depth = depth_m(p);
  if (limits_.keep_in && depth_in(*limits_.keep_in, p) <= depth) return "region.keep_in";
  for (std::size_t i = 0; i < limits_.keep_out.size(); ++i)
    if (-depth_in(limits_.keep_out[i], p) <= depth)
      return "number " + std::to_string(i + 1) + " of region.keep_out";
  return "region";
}

}  // namespace karst::core
