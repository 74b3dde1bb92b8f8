// Where the vehicle may fly: inside one prism, if there is one, outside of others, and no farther from home
// than a length of path. World frame, metres. A region says nothing of rock; the map is the same with it.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core_stack/mapping/region/prism.h"

namespace karst::core {

class FlightRegion {
 public:
  struct Limits {
    std::optional<Prism> keep_in;
    std::vector<Prism> keep_out;
    double margin_m = 0;               // kept from the border by paths, beyond their clearance
    std::optional<double> max_home_m;  // length of the path home
  };
  explicit FlightRegion(Limits limits) : limits_(std::move(limits)) {}

  const Limits& limits() const { return limits_; }

  /// Distance of `p` from the nearest place outside. Negative outside, where it is at least as great as the
  /// distance back inside, with this sign. It changes by no more than the distance moved.
  double depth_m(const Vec3& p) const;
  bool contains(const Vec3& p) const { return depth_m(p) >= 0; }
  /// Whether a path's clearance may count `p` as free.
  bool may_fly(const Vec3& p) const { return depth_m(p) >= limits_.margin_m; }
  /// The part that limits `p` most, such as "region.keep_in" or "number 2 of region.keep_out".
  std::string nearest_part(const Vec3& p) const;

 private:
  Limits limits_;
};

}  // namespace karst::core
