#include "core_stack/mission/phases/take_off.h"

namespace karst::core {
namespace {

constexpr TimeNs kSettling = kSecond;
constexpr double kClimbSpeed_mps = 0.5;

std::string metres(double m) { return std::to_string(m).substr(0, 4) + " m"; }

}  // namespace

void TakeOff::begin() {
  below_roof_ = false;
  begun_ = onboard_.now();
  onboard_.flight.climb(onboard_.now(), onboard_.options.mission.takeoff_height_m, kClimbSpeed_mps);
}

TakeOff::State TakeOff::step(bool standing) {
  if (!onboard_.flight.at_rest(onboard_.now() - kSettling)) return State::climbs;
  if (standing) return State::does_not_lift;
  if (path_.brakes_since(begun_) && !below_roof_) choose_hover();
  return onboard_.executive.under_way("hover") > 0 ? State::climbs : State::hovers;
}

/// A roof stopped the take-off. Choose a hover with room, since the vehicle returns to it at the end.
void TakeOff::choose_hover() {
  below_roof_ = true;
  onboard_.map.job(
      "hover", kMappingBudget,
      [highest = onboard_.flight.reference().position](Explorer& explorer) {
        return explorer.hover_below(highest);
      },
      [this](const Vec3& hover) { on_hover(hover); });
}

void TakeOff::on_hover(const Vec3& hover) {
  if (!phases_.in(Phase::takeoff)) return;
  const double up_m = hover.z() - onboard_.vehicle.T_world_start.position.z();
  onboard_.recorder.write(onboard_.now(), event::Log{"a low roof: it hovers " + metres(up_m) + " up, not " +
                                                     metres(onboard_.options.mission.takeoff_height_m)});
  onboard_.flight.climb(onboard_.now(), hover.z() - onboard_.flight.reference().position.z(),
                        kClimbSpeed_mps);
}

double TakeOff::ground_m() const {
  return onboard_.vehicle.T_world_start.position.z() + onboard_.options.planning.clearance_m +
         onboard_.options.map.resolution_m;
}

}  // namespace karst::core
