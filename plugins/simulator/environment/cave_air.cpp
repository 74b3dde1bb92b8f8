#include "plugins/simulator/environment/cave_air.h"

#include <algorithm>
#include <cmath>

namespace karst::sim {

using core::Vec3;

namespace {

constexpr double kFreshPuff_m = 0.8, kLargestPuff_m = 2.5, kSpread_mps = 0.4;
constexpr double kFaintest_1pm = 0.002;  // thinner clouds are dropped

cave::Cloud ball(const Vec3& position, double radius_m, double extinction_1pm, double lidar_ratio_sr) {
  cave::Cloud c;
  c.position = position;
  c.half_size_m.setConstant(radius_m);
  c.extinction_1pm = extinction_1pm;
  c.lidar_ratio_sr = lidar_ratio_sr;
  return c;
}

}  // namespace

void describe(core::OptionTable& t, AirOptions& o) {
  t.add("haze", o.haze_1pm, "1/m", 0, 10,
        "extinction of fine dust everywhere; 3 over the visibility in metres");
  t.add("mist", o.mist_1pm, "1/m", 0, 100, "extinction of droplets around the vehicle in flight");
  t.add("mist_radius", o.mist_radius_m, "m", 0.1, 20, "of that ball of droplets");
  t.add("stirred", o.stirred_1pm, "1/m", 0, 100,
        "extinction of a fresh puff of dust that the rotors lift off rock near below; one every 0.5 s");
  t.add("stirred_reach", o.stirred_reach_m, "m", 0.1, 50,
        "length of the wash, beyond which it lifts nothing");
  t.add("settling", o.settling_s, "s", 0.1, 600, "time in which dust settles to 1/e");
}

double lifted_fraction(double distance_m, double reach_m, double vehicle_radius_m) {
  const double core_m = std::min(5 * vehicle_radius_m, reach_m);  // 2.5 diameters
  if (distance_m >= reach_m) return 0;
  if (distance_m <= core_m) return 1;
  const auto above = [&](double m) { return (reach_m / m) * (reach_m / m) - 1; };
  return above(distance_m) / above(core_m);
}

CaveAir::CaveAir(const AirOptions& o, std::vector<cave::Cloud> clouds, double vehicle_radius_m)
    : options_(o), clouds_(std::move(clouds)), vehicle_radius_m_(vehicle_radius_m) {}

void CaveAir::stir(double t_s, const core::Pose& T_world_body, const cave::RayScene& scene) {
  if (options_.stirred_1pm == 0) return;
  while (!puffs_.empty() && t_s - puffs_.front().born_s > 5 * options_.settling_s) puffs_.pop_front();
  const Vec3 &p = T_world_body.position, wash = T_world_body.orientation * -Vec3::UnitZ();
  const auto lift = [&](const Vec3& place, double distance_m) {
    const double fraction = lifted_fraction(distance_m, options_.stirred_reach_m, vehicle_radius_m_);
    if (fraction > 0) puffs_.push_back({t_s, place, fraction * options_.stirred_1pm});
  };
  const double below_m = scene.ray_cast(p, wash, options_.stirred_reach_m);
  if (std::isfinite(below_m)) lift(p + below_m * wash, below_m);
  constexpr double kSlower = 2;  // half the speed, as at twice the distance
  const cave::Nearest beside = scene.nearest(p, options_.stirred_reach_m / kSlower);
  const bool is_below = (beside.point - p).normalized().dot(wash) > 0.7;
  if (beside.found && !is_below) lift(beside.point, kSlower * beside.distance_m);
}

std::vector<cave::Cloud> CaveAir::present(double t_s, const Vec3& vehicle, bool airborne) const {
  std::vector<cave::Cloud> all;
  for (const cave::Cloud& c : clouds_)
    if (t_s >= c.after_s) all.push_back(c);
  if (options_.haze_1pm > 0) all.push_back(ball(vehicle, 1e4, options_.haze_1pm, cave::Cloud::kDust_sr));
  if (options_.mist_1pm > 0 && airborne)
    all.push_back(ball(vehicle, options_.mist_radius_m, options_.mist_1pm, cave::Cloud::kDroplets_sr));
  for (const Puff& puff : puffs_) {
    const double age_s = t_s - puff.born_s;
    const double radius_m = std::min(kFreshPuff_m + kSpread_mps * age_s, kLargestPuff_m);
    const double extinction_1pm =
        puff.extinction_1pm * std::pow(kFreshPuff_m / radius_m, 3) * std::exp(-age_s / options_.settling_s);
    if (extinction_1pm > kFaintest_1pm)
      all.push_back(ball(puff.position, radius_m, extinction_1pm, cave::Cloud::kDust_sr));
  }
  return all;
}

}  // namespace karst::sim
