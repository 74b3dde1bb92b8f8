// What a vehicle does because it is one of a team: it tells the others what it does and finds, keeps apart
// from them, and lands where it is their relay.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "core_stack/mission/json_point.h"
#include "core_stack/mission/mission_control.h"

namespace karst::core {
namespace {

constexpr TimeNs kSharingBudget = 200 * kMillisecond;
constexpr TimeNs kChoiceBudget = 200 * kMillisecond;
constexpr TimeNs kAsideBudget = 300 * kMillisecond;
constexpr TimeNs kBetweenDrops = 3 * kSecond;  // by then a node has been heard
constexpr TimeNs kHeardHere = kSecond;    // of who speaks once a second: longer ago, it was somewhere else
constexpr TimeNs kUnheard = 3 * kSecond;  // hovering where it wants to land, and nobody is heard
constexpr TimeNs kLandingAgain = 2 * kSecond;
constexpr double kAtRefuge_m = 0.5;
// Returns from another vehicle are left out of the map this near to where it should be: the two estimates of
// where they are differ by so much, and it may have changed its speed since it told it.
constexpr double kAboutThere_m = 0.4, kMostStrayed_m = 1.5;

TeamPhase told(Phase phase) {
  switch (phase) {
    case Phase::standby:
      return TeamPhase::standby;
    case Phase::takeoff:
    case Phase::land:
      return TeamPhase::landing;  // neither can stop for others
    case Phase::look:
    case Phase::explore:
      return TeamPhase::explore;
    case Phase::home:
      return TeamPhase::home;
    case Phase::done:
      return TeamPhase::landed;
  }
  return TeamPhase::lost;
}

}  // namespace

void MissionControl::report_state() {
  TeamState state;
  state.position = flight_.state().position;
  state.velocity_mps = flight_.state().velocity_mps;
  state.phase = encounter_.told(told(phase_), now());
  state.seconds_left = std::max(0.0, seconds_left());
  team_->report(state, now());
}

/// Takes in what was heard, and tells what was found since.
void MissionControl::share() {
  auto facts = std::make_shared<TreeFacts>();
  auto end = std::make_shared<std::optional<Vec3>>();
  const Vec3 here = flight_.reference().position;
  const auto release = [this](TimeNs at) {
    const State s = flight_.expected(at);
    return Release{s.position, s.velocity_mps};
  };
  const Release drop_at = release(now() + kSharingBudget),
                ahead = release(now() + kSharingBudget + kSecond);  // when this is asked the next time
  const bool may_drop =
      nodes_left_ > 0 && phase_ == Phase::explore && (!dropped_at_ || now() - *dropped_at_ > kBetweenDrops);
  executive_.job(
      "team", Lane::map, kSharingBudget,
      [this, facts, end, here, drop_at, ahead, may_drop, news = team_->take_news(now(), seconds_left())] {
        *facts = explorer_.share(here, news);
        if (may_drop) *end = explorer_.reach_ends(drop_at, ahead);
      },
      [this, facts, end, drop_at, begun = now()] {
        if (!facts->empty()) team_->publish(*facts);
        if (*end && !braked_since(begun)) drop_node({drop_at.position, **end});
      });
  if (landing_ && phase_ == Phase::home && team_->overruled()) give_up_landing("another claimed it before");
}

/// A relay is heard yet, and by the map none will be in reach when this is asked the next time.
void MissionControl::drop_node(const NodeDrop& drop) {
  if (phase_ != Phase::explore || !team_->hears_base(now(), now() - 2 * kHeardHere)) return;
  --nodes_left_;
  dropped_at_ = now();
  team_->drop_node(drop);
  recorder_.event(now(), "drop", {{"ground", list(drop.ground)}, {"left", nodes_left_}});
}

void MissionControl::claim_goal(const std::optional<Goal>& goal) {
  GoalClaim claim;
  claim.stamp = team_->team_time(now());
  claim.position = goal ? goal->position : flight_.reference().position;
  claim.given_up = !goal;
  team_->publish(claim);
}

/// Where it will be a relay, or, if nothing is nearer in time, its start. For a place that it comes to too
/// late it flies, and looks again: who took the place before is a relay as soon as the rest of that news is
/// there.
void MissionControl::choose_landing() {
  home_planning_ = true;
  const std::optional<LandingSpot> before = std::exchange(landing_, std::nullopt);
  unheard_since_.reset();
  auto spot = std::make_shared<std::optional<LandingSpot>>();
  executive_.job(
      "landing place", Lane::map, kChoiceBudget,
      [this, spot, from = flight_.reference().position, come_m = flown_m_] {
        *spot = explorer_.landing_spot(from, come_m);
      },
      [this, spot, before] {
        home_planning_ = false;
        if (phase_ != Phase::home) return;
        landing_ = *spot;
        landing_again_.reset();
        if (landing_ && landing_->time_s > seconds_left()) landing_again_ = now() + kLandingAgain;
        if (landing_ && before && landing_->hover == before->hover) return;
        home_failures_ = 0;
        detour_due_ = !path_blocked_;
        if (!landing_) {
          recorder_.event(now(), "landing", {{"state", "start"}, {"reason", "no landing place is nearer"}});
          return;
        }
        team_->publish(LandingClaim{team_->team_time(now()), landing_->ground, landing_->hover,
                                    LandingClaim::State::claimed});
        recorder_.event(now(), "landing",
                        {{"state", "claimed"},
                         {"ground", list(landing_->ground)},
                         {"hover", list(landing_->hover)},
                         {"node", landing_->node},
                         {"node_claimed", landing_->claimed},
                         {"distance", landing_->length_m},
                         {"seconds_needed", landing_->time_s},
                         {"seconds_left", seconds_left()}});
      });
}

void MissionControl::give_up_landing(const std::string& reason, bool unheard) {
  recorder_.event(now(), "landing", {{"state", "given up"}, {"reason", reason}});
  team_->publish(LandingClaim{team_->team_time(now()), landing_->ground, landing_->hover,
                              LandingClaim::State::given_up});
  executive_.job(
      "give up", Lane::map, kChoiceBudget,
      [homing = team_->homing(), spot = *landing_, unheard] {
        unheard ? homing->not_heard(spot) : homing->give_up(spot.hover);
      },
      [] {});
  choose_landing();
}

/// The map's guess of a link decided where to fly; what is heard there decides whether to land. Time for
/// another place was not kept for ever: with what is left of it the vehicle lands all the same.
void MissionControl::confirm_landing() {
  if (!unheard_since_) unheard_since_ = now();
  if (team_->hears_base(now(), *unheard_since_ - kHeardHere)) {
    enter(Phase::land, "in contact");
    return;
  }
  if (now() - *unheard_since_ < kUnheard) return;
  const bool time_left = seconds_left() > options_.mission.home_reserve_s;
  if (time_left && landing_->claimed && team_->lands_soon(landing_->node, now())) {  // it waits for that one
    unheard_since_ = now();
    return;
  }
  if (!time_left) {
    enter(Phase::land, "out of contact, but there is no time for another place");
    return;
  }
  give_up_landing("nobody who reaches the base is heard there", true);
}

bool MissionControl::airspace_clear() const {
  const Vec3 hover = description_.T_world_start.position + Vec3(0, 0, options_.mission.takeoff_height_m);
  const std::vector<Neighbour> others = team_->neighbours(now());
  return std::none_of(others.begin(), others.end(), [&](const Neighbour& o) {
    return (o.position - hover).norm() < team_->options().keep_apart_m;
  });
}

/// Where the others are that move, at `stamp`: those that stand, aside or landed, are obstacles like any
/// other.
std::vector<MovingBody> MissionControl::others_at(TimeNs stamp) const {
  std::vector<MovingBody> out;
  if (!team_) return out;
  for (const Neighbour& o : team_->neighbours(now())) {
    if (o.phase == TeamPhase::aside) continue;
    const double strayed_m =
        std::min(0.5 * options_.motion.max_acceleration_mps2 * o.age_s * o.age_s, kMostStrayed_m);
    out.push_back({o.position - seconds(now() - stamp) * o.velocity_mps,
                   description_.radius_m + kAboutThere_m + strayed_m});
  }
  return out;
}

/// Another flies near: what is in the way may be gone in a moment.
bool MissionControl::in_company() const {
  if (!team_) return false;
  const std::vector<Neighbour> others = team_->neighbours(now());
  return std::any_of(others.begin(), others.end(), [this](const Neighbour& o) {
    return (o.position - flight_.state().position).norm() < 3 * team_->options().keep_apart_m;
  });
}

void MissionControl::keep_apart() {
  if (phase_ != Phase::explore && phase_ != Phase::home) {
    refuges_in_vain_.clear();
    return encounter_.forget();
  }
  if (encounter_.on_the_way() && !planning_aside_ && flight_.at_rest(now())) {
    const bool there = (flight_.reference().position - refuge_.place).norm() < kAtRefuge_m;
    encounter_.arrived(there && refuge_.others_get_by, now());
    recorder_.event(now(), "team", {{"action", "wait"}, {"others_get_by", there && refuge_.others_get_by}});
  }
  const State& s = flight_.state();
  const std::vector<Neighbour> others = team_->neighbours(now());
  const bool held = encounter_.holds();
  const RobotId held_for = encounter_.with();
  const auto action = encounter_.update({.distance_m = team_->options().keep_apart_m},
                                        {team_->self(), s.position, s.velocity_mps, told(phase_)}, others,
                                        now(), flight_.at_rest(now()));
  if (held && (!encounter_.holds() || encounter_.with() != held_for)) {
    recorder_.event(now(), "team", {{"action", "go on"}, {"robot", held_for}});
    refuges_in_vain_.clear();
    path_blocked_ = true;  // from wherever that led: a new way is due
    if (!encounter_.holds() && !flight_.at_rest(now())) brake();
  }
  if (encounter_.holds() && (!held || encounter_.with() != held_for)) {
    recorder_.event(now(), "team", {{"action", "give way"}, {"robot", encounter_.with()}});
    drop_next_goal(PolicyEvent::Kind::goal_superseded, "another vehicle is in the way");
    path_blocked_ = true;
    if (!flight_.at_rest(now())) brake();
  }
  if (action == Encounter::Action::stop) {
    recorder_.event(now(), "team", {{"action", "stop"}, {"robot", encounter_.with()}});
    if (!flight_.at_rest(now())) brake();
  }
  if (action == Encounter::Action::make_room && !planning_aside_) make_room(others);
}

/// To where the one that it gives way to gets by, or before it back along the way come; clear of all others.
void MissionControl::make_room(const std::vector<Neighbour>& others) {
  RoomQuery query;
  bool there = false;
  for (const Neighbour& o : others)
    if (o.robot == encounter_.with())
      query.other = o.position, there = true;
    else
      (o.phase == TeamPhase::aside ? query.standing : query.moving).push_back(o.position);
  if (!there) return;
  planning_aside_ = true;
  if (encounter_.stands_aside())
    refuges_in_vain_.push_back(refuge_.place);  // it waits there, and the other does not get by
  query.flown = flown_, query.in_vain = refuges_in_vain_;
  query.apart_m = team_->options().keep_apart_m / 2;
  const TimeNs start = now() + kAsideBudget;
  auto way = std::make_shared<Route>();
  auto refuge = std::make_shared<std::optional<Refuge>>();
  executive_.job(
      "make room", Lane::map, kAsideBudget,
      [this, way, refuge, start, query, lead = flight_.until_stop(start), limits = flight_.limits(0),
       narrow = narrow_places_]() mutable {
        const Vec3& from = query.from = lead.points.back();
        *refuge = explorer_.refuge(query);
        if (!*refuge || ((*refuge)->place - from).norm() < 1e-3) return;
        way->path = explorer_.plan_to(from, (*refuge)->place);
        if (way->path.found())
          *way = route(lead, way->path, std::nullopt, std::nullopt, start, kMostCut_m, limits, narrow);
        else
          refuge->reset();
      },
      [this, way, refuge, begun = now(), crowd = !query.moving.empty()] {
        planning_aside_ = false;
        if (!encounter_.holds() || braked_since(begun)) return;
        if (!*refuge) {
          encounter_.no_room(now(), crowd);
          recorder_.event(now(), "team", {{"action", "no room"}, {"robot", encounter_.with()}});
          return;
        }
        refuge_ = **refuge;
        encounter_.set_out();
        recorder_.event(now(), "team",
                        {{"action", "make room"},
                         {"robot", encounter_.with()},
                         {"to", list(refuge_.place)},
                         {"others_get_by", refuge_.others_get_by}});
        if (way->path.found()) follow(*way);
      });
}

/// On the ground for good. Called when nothing runs on the map lane any more.
void MissionControl::become_relay() {
  const bool landed = result_->stands;
  TeamState state;
  state.position = flight_.state().position;
  state.phase = landed ? TeamPhase::relay : TeamPhase::lost;
  state.seconds_left = std::max(0.0, seconds_left());
  team_->report(state, now());
  if (!landed) return;
  const Vec3 ground = flight_.state().position - Vec3(0, 0, description_.radius_m);
  const Vec3 above = ground + Vec3(0, 0, options_.mission.takeoff_height_m);
  const Vec3 hover = result_->outcome == "landed" ? landing_hover() : above;
  team_->publish(explorer_.land(hover, team_->team_time(now())));
  team_->publish(LandingClaim{team_->team_time(now()), ground, hover, LandingClaim::State::landed});
}

}  // namespace karst::core
