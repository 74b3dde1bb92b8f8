// Which points the sensors see in passing, without a stop.
#pragma once
#include <algorithm>

#include <karst/policy.h>

namespace karst {

/// Whether a sensor has an all-round view: a forward camera does not see what the vehicle passes.
inline bool sees_all_around(const Request& request) {
  constexpr double nearly_a_turn_rad = 6.0;
  return std::any_of(request.sensors.begin(), request.sensors.end(),
                     [](const Sensor& s) { return s.horizontal_fov_rad > nearly_a_turn_rad; });
}

/// The flight from the vehicle's position to a viewpoint, if its path is nearly straight.
class StraightPath {
 public:
  StraightPath(const Vec3& from, const Vec3& to, double path_length_m)
      : from_(from),
        path_(to - from),
        length_m_(norm(path_)),
        straight_(path_length_m <= max_bent * length_m_) {}

  /// Whether the flight comes within `within_m` of `p` (world), at least `before_m` before its end.
  bool passes(const Vec3& p, double within_m, double before_m = 0) const {
    if (!straight_ || length_m_ <= before_m) return false;
    const double along_m = dot(p - from_, path_) / length_m_;
    return along_m > 0 && along_m < length_m_ - before_m &&
           norm(p - from_ - (along_m / length_m_) * path_) < within_m;
  }

 private:
  static constexpr double max_bent = 1.2;  // largest ratio of path length to straight-line distance

  Vec3 from_, path_;
  double length_m_;
  bool straight_;
};

}  // namespace karst
