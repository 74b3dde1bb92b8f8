// A survey for a test: legs and leads as the host would tell them, and their distances.
//
//   bench.survey = DrawnSurvey().leg(map.place('a'), map.place('b')).leg(map.place('b'), map.place('c'))
//                      .lead(map.place('c'));
#pragma once
#include <karst_abi_survey.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <karst/types.h>

namespace karst::testing {

struct DrawnSurvey {
  std::vector<karst_survey_leg_t> legs;
  std::vector<karst_survey_lead_t> leads;

  /// Both ends `wall_m` from the walls. Legs meet where their ends are at the same place.
  DrawnSurvey& leg(const Vec3& from, const Vec3& to, double wall_m = KARST_SURVEY_DEFAULT_WALL_M) {
    const karst_survey_size_t size{wall_m, wall_m, wall_m, wall_m};
    legs.push_back({station(from), station(to), from, to, size, size, {0, 0}});
    return *this;
  }
  DrawnSurvey& lead(const Vec3& at, karst_survey_lead_kind_t kind = KARST_LEAD_END) {
    leads.push_back({at, station(at), kind, 0, {0, 0}});
    return *this;
  }

  /// As the host computes it: see karst_survey_service.
  double distance_m(const Vec3& p) const {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const karst_survey_leg_t& l : legs) nearest_m = std::min(nearest_m, distance_to(l, p));
    return nearest_m;
  }

 private:
  std::vector<Vec3> stations_;

  std::uint64_t station(const Vec3& at) {
    for (std::size_t i = 0; i < stations_.size(); ++i)
      if (distance(stations_[i], at) == 0) return i;
    stations_.push_back(at);
    return stations_.size() - 1;
  }
  double beyond_m(std::uint64_t at, const karst_survey_size_t& s) const {
    const auto meet = std::count_if(legs.begin(), legs.end(), [at](const karst_survey_leg_t& l) {
      return l.from_station == at || l.to_station == at;
    });
    return meet > 1 ? 0.5 * (s.left_m + s.right_m) : 0.0;
  }
  double distance_to(const karst_survey_leg_t& l, const Vec3& p) const {
    const double length_m = distance(l.from, l.to);
    const Vec3 along = (1 / length_m) * (Vec3(l.to) - l.from), there = p - l.from;
    const double level = std::hypot(along.x, along.y), steep = std::abs(along.z);
    const Vec3 left = level > 1e-6 ? Vec3(-along.y / level, along.x / level, 0) : Vec3(0, 1, 0);
    const Vec3 up{along.y * left.z - along.z * left.y, along.z * left.x - along.x * left.z,
                  along.x * left.y - along.y * left.x};
    const double s = dot(there, along), t = std::max(0.0, std::min(1.0, s / length_m));
    const karst_survey_size_t &a = l.from_size, &b = l.to_size;
    const auto side = [&](double from, double to) { return from + t * (to - from); };
    const auto height = [&](double from, double to) {
      return side(level * from + steep * 0.5 * (a.left_m + a.right_m),
                  level * to + steep * 0.5 * (b.left_m + b.right_m));
    };
    const double x = std::max(-s - beyond_m(l.from_station, a), s - length_m - beyond_m(l.to_station, b));
    const double y =
        std::max(dot(there, left) - side(a.left_m, b.left_m), -dot(there, left) - side(a.right_m, b.right_m));
    const double z =
        std::max(dot(there, up) - height(a.up_m, b.up_m), -dot(there, up) - height(a.down_m, b.down_m));
    return norm({std::max(x, 0.0), std::max(y, 0.0), std::max(z, 0.0)}) +
           std::min(std::max(x, std::max(y, z)), 0.0);
  }
};

}  // namespace karst::testing
