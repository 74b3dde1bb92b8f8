// What the sensors see in passing, without a stop for it.
#pragma once
#include <algorithm>

#include <karst/policy.h>

namespace karst {

/// Whether a sensor has an all-round view: a camera that faces ahead does not see what it passes.
inline bool sees_all_around(const Request& request) {
  constexpr double nearly_a_turn_rad = 6.0;
  return std::any_of(request.sensors.begin(), request.sensors.end(),
                     [](const Sensor& s) { return s.horizontal_fov_rad > nearly_a_turn_rad; });
}

/// The flight from where the vehicle is to a viewpoint, if its path is nearly straight.
class StraightPath {
 public:
  StraightPath(const Vec3& from, const Vec3& to, double path_length_m)
      : from_(from),
        path_(to - from),
        length_m_(norm(path_)),
        straight_(path_length_m <= max_bent * length_m_) {}

  /// Whether it comes within `within_m` of `p`, `before_m` or more before its end.
  bool passes(const Vec3& p, double within_m, double before_m = 0) const {
    if (!straight_ || length_m_ <= before_m) return false;
    const double along_m = dot(p - from_, path_) / length_m_;
    return along_m > 0 && along_m < length_m_ - before_m &&
           norm(p - from_ - (along_m / length_m_) * path_) < within_m;
  }

 private:
  static constexpr double max_bent = 1.2;  // a path no longer than that many times the straight line

  Vec3 from_, path_;
  double length_m_;
  bool straight_;
};

}  // namespace karst
