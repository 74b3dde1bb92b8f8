#include "core_stack/mission/team/right_of_way.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "core_stack/mission/recording/json_point.h"

namespace karst::core {
namespace {

constexpr TimeNs kAsideBudget = 300 * kMillisecond;
constexpr double kAtRefuge_m = 0.5;

}  // namespace

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

TeamPhase RightOfWay::told_now() const {
  return encounter_.told(told(parts_.phases.phase()), onboard_.now());
}

void RightOfWay::step() {
  if (!parts_.phases.under_way()) {
    refuges_in_vain_.clear();
    encounter_.forget();
    return parts_.path.yield(encounter_.holds());
  }
  const TimeNs now = onboard_.now();
  note_arrival();
  const State& s = onboard_.flight.state();
  const std::vector<Neighbour> others = team_.neighbours(now);
  const bool held = encounter_.holds();
  const RobotId held_for = encounter_.with();
  const auto action =
      encounter_.update({.distance_m = team_.options().keep_apart_m},
                        {team_.self(), s.position, s.velocity_mps, told(parts_.phases.phase())}, others, now,
                        onboard_.flight.at_rest(now));
  on_change(held, held_for);
  if (action == Encounter::Action::stop) {
    onboard_.recorder.event(now, "team", {{"action", "stop"}, {"robot", encounter_.with()}});
    parts_.path.stop(now);
  }
  if (action == Encounter::Action::make_room && !planning_) make_room(others);
  parts_.path.yield(encounter_.holds());
}

void RightOfWay::note_arrival() {
  const TimeNs now = onboard_.now();
  if (!encounter_.on_the_way() || planning_ || !onboard_.flight.at_rest(now)) return;
  const bool there = (onboard_.flight.reference().position - refuge_.place).norm() < kAtRefuge_m;
  encounter_.arrived(there && refuge_.others_get_by, now);
  onboard_.recorder.event(now, "team",
                          {{"action", "wait"}, {"others_get_by", there && refuge_.others_get_by}});
}

/// It was held for that robot, and is not any more; or it is held for another one.
void RightOfWay::on_change(bool held, RobotId held_for) {
  const TimeNs now = onboard_.now();
  const bool holds = encounter_.holds(), same = held && holds && encounter_.with() == held_for;
  if (held && !same) {
    onboard_.recorder.event(now, "team", {{"action", "go on"}, {"robot", held_for}});
    refuges_in_vain_.clear();
    parts_.path.block();  // from wherever that led: a new way is due
    if (!holds) parts_.path.stop(now);
  }
  if (holds && !same) {
    onboard_.recorder.event(now, "team", {{"action", "give way"}, {"robot", encounter_.with()}});
    parts_.goals.drop_next(GoalFate::superseded, "another vehicle is in the way", now);
    parts_.path.block();
    parts_.path.stop(now);
  }
}

/// To where the one that it gives way to gets by, or before it back along the way come; clear of all others.
void RightOfWay::make_room(const std::vector<Neighbour>& others) {
  RoomQuery query;
  bool there = false;
  for (const Neighbour& o : others) {
    if (o.robot == encounter_.with()) {
      query.other = o.position;
      there = true;
    } else {
      (o.phase == TeamPhase::aside ? query.standing : query.moving).push_back(o.position);
    }
  }
  if (!there) return;
  planning_ = true;
  if (encounter_.stands_aside())
    refuges_in_vain_.push_back(refuge_.place);  // it waits there, and the other does not get by
  query.flown = parts_.way_flown.points();
  query.in_vain = refuges_in_vain_;
  query.apart_m = team_.options().keep_apart_m / 2;
  const TimeNs begun = onboard_.now();
  onboard_.map.job(
      "make room", kAsideBudget,
      [this, query, start = parts_.path.start_at_stop(begun + kAsideBudget)](Explorer& explorer) {
        return find_room(explorer, query, start);
      },
      [this, begun, crowd = !query.moving.empty()](const Room& room) { on_room(room, begun, crowd); });
}

RightOfWay::Room RightOfWay::find_room(Explorer& explorer, RoomQuery query, const RouteStart& start) const {
  const Vec3& from = start.lead.points.back();
  query.from = from;
  Room room;
  room.refuge = explorer.refuge(query);
  if (!room.refuge || (room.refuge->place - from).norm() < 1e-3) return room;
  const Path path = explorer.plan_to(from, room.refuge->place);
  if (path.found())
    room.route = make_route(explorer.map(), onboard_.options, onboard_.vehicle, start, path, {});
  else
    room.refuge.reset();
  return room;
}

void RightOfWay::on_room(const Room& room, TimeNs begun, bool crowd) {
  planning_ = false;
  const TimeNs now = onboard_.now();
  if (!encounter_.holds() || parts_.path.braked_since(begun)) return;
  if (!room.refuge) {
    encounter_.no_room(now, crowd);
    onboard_.recorder.event(now, "team", {{"action", "no room"}, {"robot", encounter_.with()}});
    return;
  }
  refuge_ = *room.refuge;
  encounter_.set_out();
  onboard_.recorder.event(now, "team",
                          {{"action", "make room"},
                           {"robot", encounter_.with()},
                           {"to", list(refuge_.place)},
                           {"others_get_by", refuge_.others_get_by}});
  if (room.route.path.found()) parts_.path.follow(room.route, now);
}

}  // namespace karst::core
