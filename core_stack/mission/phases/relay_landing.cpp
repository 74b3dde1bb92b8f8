#include "core_stack/mission/phases/relay_landing.h"

#include <utility>

namespace karst::core {
namespace {

constexpr TimeNs kChoiceBudget = 200 * kMillisecond;
constexpr TimeNs kHeardHere = kSecond;    // states come once a second: earlier ones were received elsewhere
constexpr TimeNs kUnheard = 3 * kSecond;  // maximal time without radio contact while hovering above the site
constexpr TimeNs kLandingAgain = 2 * kSecond;

}  // namespace

/// If the vehicle would reach the site too late, it flies on to it and chooses again there: the robot that
/// took the site becomes a relay as soon as its landing is known.
void RelayLanding::choose(double flown_length_m, std::function<void()> over, std::function<void()> changed) {
  const std::optional<LandingSpot> before = std::exchange(spot_, std::nullopt);
  unheard_since_.reset();
  onboard_.map.job(
      "landing place", kChoiceBudget,
      [from = onboard_.flight.reference().position, flown_length_m](Explorer& explorer) {
        return explorer.landing_spot(from, flown_length_m);
      },
      [this, before, over = std::move(over),
       changed = std::move(changed)](const std::optional<LandingSpot>& spot) {
        over();
        if (!phases_.in(Phase::home)) return;
        spot_ = spot;
        on_choice(before, changed);
      });
}

void RelayLanding::on_choice(const std::optional<LandingSpot>& before, const std::function<void()>& changed) {
  const TimeNs now = onboard_.now();
  const double seconds_left = endurance_.seconds_left(now);
  look_again_.reset();
  if (spot_ && spot_->time_s > seconds_left) look_again_ = now + kLandingAgain;
  if (spot_ && before && spot_->hover == before->hover) return;
  changed();
  if (!spot_) {
    onboard_.recorder.write(
        now, event::Landing{.state = event::LandingState::start, .reason = "no landing place is nearer"});
    return;
  }
  team_.publish(
      LandingClaim{team_.team_time(now), spot_->ground, spot_->hover, LandingClaim::State::claimed});
  onboard_.recorder.write(now, event::Landing{.state = event::LandingState::claimed,
                                              .ground = spot_->ground,
                                              .hover = spot_->hover,
                                              .node = spot_->node,
                                              .node_claimed = spot_->claimed,
                                              .distance_m = spot_->length_m,
                                              .seconds_needed = spot_->time_s,
                                              .seconds_left = seconds_left});
}

void RelayLanding::give_up(const std::string& reason, Because because) {
  const TimeNs now = onboard_.now();
  onboard_.recorder.write(now, event::Landing{.state = event::LandingState::given_up, .reason = reason});
  team_.publish(
      LandingClaim{team_.team_time(now), spot_->ground, spot_->hover, LandingClaim::State::given_up});
  onboard_.map.job("give up", kChoiceBudget, [homing = team_.homing(), spot = *spot_, because](Explorer&) {
    if (because == Because::no_contact)
      homing->no_contact_at(spot);
    else
      homing->give_up(spot.hover);
  });
}

/// The predicted link decided where to fly; the measured one decides whether to land. The reserve for another
/// site is limited: once it is used up the vehicle lands anyway.
RelayLanding::Heard RelayLanding::listen(std::string& why) {
  const TimeNs now = onboard_.now();
  if (!unheard_since_) unheard_since_ = now;
  if (team_.base_in_contact(now, *unheard_since_ - kHeardHere)) {
    why = "in contact";
    return Heard::lands;
  }
  if (now - *unheard_since_ < kUnheard) return Heard::waits;
  const bool time_left = endurance_.seconds_left(now) > onboard_.options.mission.home_reserve_s;
  if (time_left && spot_->claimed && team_.lands_soon(spot_->node, now)) {  // it waits for that robot
    unheard_since_ = now;
    return Heard::waits;
  }
  if (time_left) return Heard::nobody;
  why = "out of contact, but there is no time for another place";
  return Heard::lands;
}

}  // namespace karst::core
