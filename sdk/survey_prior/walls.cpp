#include "sdk/survey_prior/walls.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace karst::survey_prior {
namespace {

using core::Vec3;
using survey::Dimensions;

/// Takes what is not measured yet.
void fill(std::optional<double>& distance_m, const std::optional<double>& from) {
  if (!distance_m && from) distance_m = std::max(0.0, *from);
}

/// As seen from the other side.
Dimensions turned(const Dimensions& d) { return {d.right_m, d.left_m, d.up_m, d.down_m}; }

void fill(Dimensions& d, const Dimensions& from) {
  fill(d.left_m, from.left_m);
  fill(d.right_m, from.right_m);
  fill(d.up_m, from.up_m);
  fill(d.down_m, from.down_m);
}

void reach(std::optional<double>& distance_m, double to_m) {
  if (to_m > 0) distance_m = std::max(distance_m.value_or(0), to_m);
}

}  // namespace

Walls::Walls(const survey::Survey& survey)
    : survey_(survey), sections_(survey.stations.size()), splays_(survey.stations.size()) {
  for (std::uint32_t i = 0; i < survey.sections.size(); ++i)
    sections_[survey.sections[i].station].push_back(i);
  for (std::uint32_t i = 0; i < survey.splays.size(); ++i)
    if (!survey.splays[i].surface) splays_[survey.splays[i].station].push_back(i);
}

core::PassageSize Walls::at(const survey::Leg& leg, std::uint32_t station) const {
  constexpr double kLooksAlong = 0.5;  // cosine
  const Vec3 here = survey_.stations[station].position_m;
  const Vec3 way = survey_.stations[leg.to].position_m - survey_.stations[leg.from].position_m;
  const double level_m = std::hypot(way.x(), way.y());
  const Vec3 ahead = level_m > 1e-6 ? Vec3(way.x() / level_m, way.y() / level_m, 0) : Vec3::UnitX();
  const Vec3 left(-ahead.y(), ahead.x(), 0);

  Dimensions walls;
  for (const bool own_run : {true, false})
    for (const std::uint32_t i : sections_[station]) {
      const survey::Section& s = survey_.sections[i];
      const double cosine = s.facing.dot(ahead);
      if ((s.run == leg.run) != own_run || (!own_run && std::abs(cosine) < kLooksAlong)) continue;
      fill(walls, cosine < 0 ? turned(s.dimensions) : s.dimensions);
    }
  Dimensions seen;
  for (const std::uint32_t i : splays_[station]) {
    const Vec3 shot = survey_.splays[i].end_m - here;
    const double along_m = shot.dot(way.normalized());
    if (along_m * along_m > 0.5 * shot.squaredNorm()) continue;  // it runs along the passage
    reach(seen.left_m, shot.dot(left));
    reach(seen.right_m, -shot.dot(left));
    reach(seen.up_m, shot.z());
    reach(seen.down_m, -shot.z());
  }
  fill(walls, seen);
  const double none = core::kUnmeasuredWall_m;
  return {walls.left_m.value_or(none), walls.right_m.value_or(none), walls.up_m.value_or(none),
          walls.down_m.value_or(none)};
}

}  // namespace karst::survey_prior
