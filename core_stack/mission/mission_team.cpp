// What a vehicle does because it is one of a team: it tells the others what it does and finds, keeps apart
// from them, and lands where it is their relay.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "core_stack/mission/mission_control.h"

namespace karst::core {
namespace {

constexpr TimeNs kSharingBudget = 200 * kMillisecond;
constexpr TimeNs kChoiceBudget = 200 * kMillisecond;
constexpr TimeNs kAsideBudget = 300 * kMillisecond;
constexpr TimeNs kPatience = 5 * kSecond;  // it stands and waits so long before it steps aside
constexpr TimeNs kAsideAgain = 10 * kSecond;
constexpr TimeNs kUnheard = 3 * kSecond;  // hovering where it wants to land, and nobody is heard
constexpr double kGoOn = 1.3;             // times the distance at which it stopped: then it goes on

nlohmann::json list(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

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
  state.phase = told(phase_);
  state.seconds_left = std::max(0.0, seconds_left());
  team_->report(state, now());
}

/// Takes in what was heard, and tells what was found since.
void MissionControl::share() {
  auto facts = std::make_shared<TreeFacts>();
  executive_.job(
      "team", Lane::map, kSharingBudget,
      [this, facts, here = flight_.reference().position, news = team_->take_news(now())] {
        *facts = explorer_.share(here, news);
      },
      [this, facts] {
        if (!facts->empty()) team_->publish(*facts);
      });
  if (landing_ && phase_ == Phase::home && team_->overruled()) give_up_landing("another claimed it before");
}

void MissionControl::claim_goal(const std::optional<Goal>& goal) {
  GoalClaim claim;
  claim.stamp = team_->team_time(now());
  claim.position = goal ? goal->position : flight_.reference().position;
  claim.given_up = !goal;
  team_->publish(claim);
}

/// Where it will be a relay, or, if nothing is nearer in time, its start.
void MissionControl::choose_landing() {
  home_planning_ = true;
  landing_.reset();
  unheard_since_.reset();
  auto spot = std::make_shared<std::optional<LandingSpot>>();
  executive_.job(
      "landing place", Lane::map, kChoiceBudget,
      [this, spot, from = flight_.reference().position, come_m = flown_m_] {
        *spot = explorer_.landing_spot(from, come_m);
      },
      [this, spot] {
        home_planning_ = false;
        if (phase_ != Phase::home) return;
        landing_ = *spot;
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
                         {"distance", landing_->length_m},
                         {"seconds_needed", landing_->time_s},
                         {"seconds_left", seconds_left()}});
      });
}

void MissionControl::give_up_landing(const std::string& reason) {
  recorder_.event(now(), "landing", {{"state", "given up"}, {"reason", reason}});
  team_->publish(LandingClaim{team_->team_time(now()), landing_->ground, landing_->hover,
                              LandingClaim::State::given_up});
  executive_.job(
      "give up", Lane::map, kChoiceBudget,
      [homing = team_->homing(), hover = landing_->hover] { homing->give_up(hover); }, [] {});
  choose_landing();
}

/// The map's guess of a link decided where to fly; what is heard there decides whether to land. Time for
/// another place was not kept for ever: with what is left of it the vehicle lands all the same.
void MissionControl::confirm_landing() {
  if (team_->hears_base(now())) {
    enter(Phase::land, "in contact");
    return;
  }
  if (!unheard_since_) unheard_since_ = now();
  if (now() - *unheard_since_ < kUnheard) return;
  if (seconds_left() < options_.mission.home_reserve_s) {
    enter(Phase::land, "out of contact, but there is no time for another place");
    return;
  }
  give_up_landing("nobody who reaches the base is heard there");
}

bool MissionControl::airspace_clear() const {
  const Vec3 hover = description_.T_world_start.position + Vec3(0, 0, options_.mission.takeoff_height_m);
  const std::vector<Neighbour> others = team_->neighbours(now());
  return std::none_of(others.begin(), others.end(), [&](const Neighbour& o) {
    return (o.position - hover).norm() < team_->options().keep_apart_m;
  });
}

void MissionControl::keep_apart() {
  if (phase_ != Phase::explore && phase_ != Phase::home) {
    giving_way_since_.reset();
    return;
  }
  KeepApart rule{.distance_m = team_->options().keep_apart_m};
  if (giving_way_since_) rule.distance_m *= kGoOn;
  const State& s = flight_.state();
  const std::vector<Neighbour> before =
      give_way_to(rule, team_->self(), s.position, s.velocity_mps, team_->neighbours(now()));
  if (before.empty()) {
    if (!giving_way_since_) return;
    recorder_.event(now(), "team", {{"action", "go on"}});
    giving_way_since_.reset();
    path_blocked_ = true;  // from wherever that led: a new way is due
    if (!flight_.at_rest(now())) brake();
    return;
  }
  if (!giving_way_since_) {
    giving_way_since_ = now();
    recorder_.event(now(), "team", {{"action", "give way"}, {"robot", before.front().robot}});
    drop_next_goal(PolicyEvent::Kind::goal_superseded, "another vehicle is in the way");
    path_blocked_ = true;
    if (!flight_.at_rest(now())) brake();
  } else if (now() - *giving_way_since_ > kPatience && now() - stepped_aside_ > kAsideAgain &&
             !stepping_aside_ && flight_.at_rest(now())) {
    step_aside(before);
  }
}

/// Back along the way come to where another gets by.
void MissionControl::step_aside(const std::vector<Neighbour>& others) {
  stepping_aside_ = true;
  stepped_aside_ = now();
  const TimeNs start = now() + kAsideBudget;
  auto way = std::make_shared<Route>();
  executive_.job(
      "step aside", Lane::map, kAsideBudget,
      [this, way, start, others, lead = flight_.until_stop(start), limits = flight_.limits(0), flown = flown_,
       apart_m = team_->options().keep_apart_m, narrow = narrow_places_] {
        const auto place = explorer_.lay_by(flown, others, apart_m);
        if (!place) return;
        way->path = explorer_.plan_to(lead.points.back(), *place);
        if (way->path.found())
          *way = route(lead, way->path, std::nullopt, std::nullopt, start, kMostCut_m, limits, narrow);
      },
      [this, way, begun = now()] {
        stepping_aside_ = false;
        if (!giving_way_since_ || !way->path.found() || braked_since(begun)) return;
        recorder_.event(now(), "team", {{"action", "step aside"}, {"to", list(way->path.points.back())}});
        follow(*way);
      });
}

/// On the ground for good. Called when nothing runs on the map lane any more.
void MissionControl::become_relay() {
  const bool landed = result_->outcome == "landed" || result_->outcome == "stuck";
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
