// Ray-triangle intersection: bit-identical on every processor, and no ray slips between two triangles.
#pragma once
#include <optional>

#include "core_stack/common/geometry.h"

namespace karst::cave {

/// Range along the unit vector `d` at which the ray from `o` passes through triangle a, b, c; nullopt if the
/// ray misses it, lies in its plane or would meet it behind `o`.
///
/// By the volumes of the tetrahedra that the ray spans with the edges (scalar triple products; Kensler and
/// Shirley, Optimizing Ray-Triangle Intersection via Automated Search, 2006). An edge's volume only changes
/// its sign when its ends are swapped, to the last bit: a ray that passes a shared edge outside one triangle
/// passes it inside the neighbouring one.
inline std::optional<double> ray_triangle_range(const core::Vec3& o, const core::Vec3& d, const core::Vec3& a,
                                                const core::Vec3& b, const core::Vec3& c) {
  const core::Vec3 oa = a - o, ob = b - o, oc = c - o;
  const double u = d.dot(oc.cross(ob)), v = d.dot(oa.cross(oc));
  if ((u < 0 && v > 0) || (u > 0 && v < 0)) return std::nullopt;
  const double w = d.dot(ob.cross(oa));
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return std::nullopt;
  const double sum = u + v + w;
  if (sum == 0) return std::nullopt;
  const double range = d.dot(u * oa + v * ob + w * oc) / sum;
  if (range < 0) return std::nullopt;
  return range;
}

}  // namespace karst::cave
