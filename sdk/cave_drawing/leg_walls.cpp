#include "sdk/cave_drawing/leg_walls.h"

#include <cmath>

namespace karst::cave_drawing {

LegWalls::LegWalls(const survey::Survey& survey) : survey_(survey) {
  for (std::size_t i = 0; i < survey.sections.size(); ++i) {
    const survey::Section& s = survey.sections[i];
    if (!s.dimensions.any()) continue;
    of_run_.emplace(std::pair(s.station, s.run), i);
    of_station_.emplace(s.station, i);
  }
}

LegEnd LegWalls::end_of(std::uint32_t station, std::uint32_t run) const {
  LegEnd end;
  end.station = end.left = end.right = survey_.stations[station].position_m;
  std::optional<std::size_t> found;
  if (const auto own = of_run_.find({station, run}); own != of_run_.end())
    found = own->second;
  else if (const auto other = of_station_.find(station); other != of_station_.end())
    found = other->second;
  if (!found) return end;
  const survey::Section& section = survey_.sections[*found];
  const core::Vec3 to_left(-section.facing.y(), section.facing.x(), 0);
  const double left_m = section.dimensions.left_m.value_or(0),
               right_m = section.dimensions.right_m.value_or(0);
  end.left += left_m * to_left;
  end.right -= right_m * to_left;
  end.width_m = left_m + right_m;
  end.up_m = section.dimensions.up_m.value_or(0);
  end.down_m = section.dimensions.down_m.value_or(0);
  return end;
}

std::array<LegEnd, 2> LegWalls::of(const survey::Leg& leg) const {
  return {end_of(leg.from, leg.run), end_of(leg.to, leg.run)};
}

bool is_steep(const std::array<LegEnd, 2>& ends) {
  const core::Vec3 d = ends[1].station - ends[0].station;
  return std::abs(d.z()) > d.head<2>().norm();
}

}  // namespace karst::cave_drawing
