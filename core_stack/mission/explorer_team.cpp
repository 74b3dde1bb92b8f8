// What the map has to do with a team: the homing tree, landing places, goals that others claimed.
#include <algorithm>
#include <utility>

#include "core_stack/homing/landing_ground.h"
#include "core_stack/mission/explorer.h"

namespace karst::core {
namespace {

constexpr double kLayByStep_m = 1.0, kLayByReach_m = 40.0;
constexpr double kGetBy_m = 3.0;

}  // namespace

TreeFacts Explorer::share(const Vec3& here, const TeamNews& news) {
  return homing_->update(map_, wide().roadmap, here, news, std::exchange(closed_, {}));
}

std::optional<LandingSpot> Explorer::landing_spot(const Vec3& from, double way_come_m) {
  const HomeEstimate base = estimate_base(from, way_come_m);
  const auto spot = homing_->spot_from(map_, wide_.roadmap, from);
  return spot && spot->time_s < base.time_s ? spot : std::nullopt;
}

TreeFacts Explorer::land(const Vec3& hover, TimeNs team_time) {
  return homing_->land(map_, wide().roadmap, hover, team_time);
}

std::optional<Vec3> Explorer::lay_by(const std::vector<Vec3>& flown, const std::vector<Neighbour>& others,
                                     double apart_m) const {
  double back_m = 0, next_m = 0;
  for (std::size_t i = flown.size(); i-- > 0 && back_m < kLayByReach_m;) {
    if (i + 1 < flown.size()) back_m += (flown[i + 1] - flown[i]).norm();
    if (back_m < next_m) continue;
    next_m += kLayByStep_m;
    const bool apart = std::all_of(others.begin(), others.end(), [&](const Neighbour& o) {
      return (o.position - flown[i]).norm() > apart_m;
    });
    if (apart && others_get_by(map_, flown[i], vehicle_.radius_m,
                               search_clearance_m(options_.planning, map_.resolution_m()), kGetBy_m))
      return flown[i];
  }
  return std::nullopt;
}

bool Explorer::left_to_others(const Vec3& frontier) const {
  if (!homing_ || claims_waived_) return false;
  const std::vector<Vec3>& goals = homing_->others_goals();
  return std::any_of(goals.begin(), goals.end(),
                     [&](const Vec3& g) { return (g - frontier).norm() < claim_radius_m_; });
}

}  // namespace karst::core
