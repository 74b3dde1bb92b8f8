#include "core_stack/mission/team/team_sharing.h"

#include <algorithm>

namespace karst::core {
namespace {

constexpr TimeNs kSharingBudget = 200 * kMillisecond;
constexpr TimeNs kBetweenDrops = 3 * kSecond;  // by then a node has been heard
constexpr TimeNs kHeardLately = 2 * kSecond;   // of who speaks once a second
constexpr double kComesHome_m = 10.0;          // so near: it lands before another takes off beside its way
constexpr TimeNs kMayBeNear = 12 * kSecond;    // after its last word
constexpr double kMayCome_mps = 1.0;           // on average, through a cave
// Returns from another vehicle are left out of the map this near to where it should be: the two estimates of
// where they are differ by so much, and it may have changed its speed since it told it.
constexpr double kAboutThere_m = 0.4, kMaxStrayed_m = 1.5;
constexpr double kInSight_s = 0.4;  // since it was seen

/// The facts to publish, and where a node dropped now would land.
struct Shared {
  TreeFacts facts;
  std::optional<Vec3> drop_ground;
};

Release release_at(const Flight& flight, TimeNs at) {
  const State s = flight.expected(at);
  return {s.position, s.velocity_mps};
}

}  // namespace

void TeamSharing::report(TeamPhase phase) {
  const TimeNs now = onboard_.now();
  TeamState state;
  state.position = onboard_.flight.state().position;
  state.velocity_mps = onboard_.flight.state().velocity_mps;
  state.phase = phase;
  state.seconds_left = std::max(0.0, parts_.endurance.seconds_left(now));
  team_.report(state, now);
}

bool TeamSharing::may_drop() const {
  return nodes_left_ > 0 && parts_.phases.explores() &&
         (!dropped_at_ || onboard_.now() - *dropped_at_ > kBetweenDrops);
}

void TeamSharing::share() {
  const TimeNs now = onboard_.now();
  const Vec3 here = onboard_.flight.reference().position;
  const Release drop = release_at(onboard_.flight, now + kSharingBudget);
  const Release next = release_at(onboard_.flight, now + kSharingBudget + kSecond);  // at the next call
  onboard_.map.job(
      "team", kSharingBudget,
      [here, drop, next, may_drop = may_drop(),
       news = team_.take_news(now, parts_.endurance.seconds_left(now))](Explorer& explorer) {
        Shared out;
        out.facts = explorer.share(here, news);
        if (may_drop) out.drop_ground = explorer.relay_drop_site(drop, next);
        return out;
      },
      [this, from = drop.position, begun = now](const Shared& shared) {
        if (!shared.facts.empty()) team_.publish(shared.facts);
        if (shared.drop_ground && !parts_.path.braked_since(begun)) drop_node({from, *shared.drop_ground});
      });
}

/// Drops a node if the base is still in contact; by the map no relay will be in range at the next call.
void TeamSharing::drop_node(const NodeDrop& drop) {
  const TimeNs now = onboard_.now();
  if (!parts_.phases.explores() || !team_.base_in_contact(now, now - kHeardLately)) return;
  --nodes_left_;
  dropped_at_ = now;
  team_.drop_node(drop);
  onboard_.recorder.write(now, event::Drop{drop.ground, nodes_left_});
}

void TeamSharing::claim_goal(const Goal& goal) {
  GoalClaim claim;
  claim.stamp = team_.team_time(onboard_.now());
  claim.position = goal.position;
  team_.publish(claim);
}

void TeamSharing::give_up_goals() {
  GoalClaim claim;
  claim.stamp = team_.team_time(onboard_.now());
  claim.position = onboard_.flight.reference().position;
  claim.given_up = true;
  team_.publish(claim);
}

bool TeamSharing::airspace_clear() const {
  const Vec3 hover =
      onboard_.vehicle.T_world_start.position + Vec3(0, 0, onboard_.options.mission.takeoff_height_m);
  const double separation_m = team_.options().separation_m;
  const auto in_the_way = [&](const Neighbour& o) {
    return (o.position - hover).norm() < (o.phase == TeamPhase::home ? kComesHome_m : separation_m);
  };
  // One that has fallen silent may have come from where it was last heard.
  const auto may_have_come = [&](const Neighbour& o) {
    const Vec3 reported_at = o.position - o.age_s * o.velocity_mps;
    return o.age_s > seconds(kNewsHold) &&
           (reported_at - hover).norm() < separation_m + kMayCome_mps * o.age_s;
  };
  const std::vector<Neighbour> others = team_.neighbours(onboard_.now()),
                               silent = team_.heard(onboard_.now(), kMayBeNear);
  return std::none_of(others.begin(), others.end(), in_the_way) &&
         std::none_of(silent.begin(), silent.end(), may_have_come);
}

bool TeamSharing::in_company() const {
  const std::vector<Neighbour> others = team_.neighbours(onboard_.now());
  return std::any_of(others.begin(), others.end(), [this](const Neighbour& o) {
    return (o.position - onboard_.flight.state().position).norm() < 3 * team_.options().separation_m;
  });
}

std::vector<MovingBody> TeamSharing::others_at(TimeNs stamp) const {
  const TimeNs now = onboard_.now();
  std::vector<MovingBody> out;
  for (const Neighbour& o : team_.neighbours(now)) {
    if (o.phase == TeamPhase::aside) continue;
    if (!o.heard && o.age_s > kInSight_s) continue;  // where it is by now is a guess: rock may be there
    const double strayed_m =
        std::min(0.5 * onboard_.options.motion.max_acceleration_mps2 * o.age_s * o.age_s, kMaxStrayed_m);
    out.push_back({o.position - seconds(now - stamp) * o.velocity_mps,
                   onboard_.vehicle.radius_m + kAboutThere_m + strayed_m});
  }
  return out;
}

void TeamSharing::become_relay(bool stands, const std::optional<Vec3>& landed_below) {
  const TimeNs now = onboard_.now(), team_time = team_.team_time(now);
  TeamState state;
  state.position = onboard_.flight.state().position;
  state.phase = stands ? TeamPhase::relay : TeamPhase::lost;
  state.seconds_left = std::max(0.0, parts_.endurance.seconds_left(now));
  team_.report(state, now);
  if (!stands) return;
  const Vec3 ground = state.position - Vec3(0, 0, onboard_.vehicle.radius_m);
  const Vec3 hover = landed_below.value_or(ground + Vec3(0, 0, onboard_.options.mission.takeoff_height_m));
  team_.publish(onboard_.map.while_idle().land(hover, team_time));
  team_.publish(LandingClaim{team_time, ground, hover, LandingClaim::State::landed});
}

}  // namespace karst::core
