#include "core_stack/mission/team/right_of_way.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace karst::core {
namespace {

constexpr TimeNs kAsideBudget = 300 * kMillisecond;
constexpr double kAtWaitingPlace_m = 0.5;
constexpr double kFlies_mps = 0.2;
// Two vehicles whose cameras see 4.5 m need 0.7 s to know each other and begin to brake: at 1 m/s each they
// stop 2 m apart.
constexpr double kSeen_mps = 1.0, kUnseen_mps = 0.5;
constexpr double kNearUnheard_m = 6.0, kPassing_mps = 0.7;
constexpr double kBrake_mps2 = 1.0, kTracked = 0.95;  // of the acceleration, the rest is for control
constexpr double kCrowd_m = 12.0;
const double kLooks = std::cos(0.75);  // half a camera's field of view

/// For the record: one that is seen and not heard has no number.
std::optional<std::uint32_t> number_of(RobotId robot) {
  return robot < kMaxRobots ? std::optional<std::uint32_t>(robot) : std::nullopt;
}

}  // namespace

TeamPhase phase_for_team(Phase phase) {
  switch (phase) {
    case Phase::standby:
      return TeamPhase::standby;
    case Phase::takeoff:
    case Phase::land:
    case Phase::manual:
      return TeamPhase::landing;  // in both it cannot stop for others
    case Phase::look:
    case Phase::explore:
      return TeamPhase::explore;
    case Phase::home:
      return TeamPhase::home;
    case Phase::done:
    case Phase::replay:
      return TeamPhase::landed;
  }
  return TeamPhase::lost;
}

TeamPhase RightOfWay::phase_to_report() const {
  return yield_state_.reported(phase_for_team(parts_.phases.phase()), onboard_.now());
}

/// The vehicle passes one that it does not hear slowly, also where that one stands: it may set out. It does
/// not slow down where it flies away from it: that one follows, and would have to be as slow. Without a
/// LiDAR, and while it may meet one, it flies no faster than its cameras see, and slower where they do not
/// look: they look level.
void RightOfWay::look_out(const std::vector<Neighbour>& others) {
  max_speed_mps_.reset();
  const Vec3 &p = onboard_.flight.state().position, &v = onboard_.flight.state().velocity_mps;
  const bool passes = std::any_of(others.begin(), others.end(), [&](const Neighbour& o) {
    const Vec3 to_other = o.position - p;
    return !o.heard && to_other.norm() < kNearUnheard_m && v.dot(to_other) > -kFlies_mps * to_other.norm();
  });
  if (passes) max_speed_mps_ = kPassing_mps;
  if (onboard_.vehicle.lidar || !team_.may_meet_unheard(onboard_.now())) return;
  max_speed_mps_ = max_speed_mps_.value_or(kSeen_mps);
  const double speed_mps = v.norm(), heading_rad = onboard_.flight.reference().heading_rad;
  const double ahead_mps = v.x() * std::cos(heading_rad) + v.y() * std::sin(heading_rad);
  if (speed_mps > kFlies_mps && ahead_mps < kLooks * speed_mps) max_speed_mps_ = kUnseen_mps;
}

void RightOfWay::step() {
  if (!parts_.phases.under_way()) {
    failed_places_.clear();
    max_speed_mps_.reset();
    yield_state_.forget();
    return parts_.path.yield(yield_state_.holds());
  }
  const TimeNs now = onboard_.now();
  note_arrival();
  const State& s = onboard_.flight.state();
  const std::vector<Neighbour> others = team_.neighbours(now);
  look_out(others);
  const bool held = yield_state_.holds();
  const RobotId held_for = yield_state_.with();
  const auto action = yield_state_.update(
      {.distance_m = team_.options().separation_m,
       .brake_mps2 = std::min(kBrake_mps2, kTracked * onboard_.options.motion.max_acceleration_mps2)},
      {team_.self(), s.position, s.velocity_mps, phase_for_team(parts_.phases.phase())}, others, now,
      onboard_.flight.at_rest(now), still_.still_for(onboard_.flight.reference().position, now));
  on_change(held, held_for);
  if (action == YieldState::Action::stop) {
    onboard_.recorder.write(
        now, event::Team{.action = event::TeamAction::stop, .robot = number_of(yield_state_.with())});
    parts_.path.stop(now);
  }
  if (action == YieldState::Action::leave) note_failed(onboard_.flight.reference().position);
  if (action == YieldState::Action::make_room || action == YieldState::Action::leave) make_room(others);
  parts_.path.yield(yield_state_.holds());
}

void RightOfWay::note_arrival() {
  const TimeNs now = onboard_.now();
  if (!yield_state_.on_the_way() || !onboard_.flight.at_rest(now)) return;
  const bool there = (onboard_.flight.reference().position - waiting_place_.place).norm() < kAtWaitingPlace_m;
  const bool keeps_passage_open = there && waiting_place_.keeps_passage_open;
  yield_state_.arrived(keeps_passage_open ? YieldState::Place::aside : YieldState::Place::in_the_way, now);
  onboard_.recorder.write(
      now, event::Team{.action = event::TeamAction::wait, .keeps_passage_open = keeps_passage_open});
}

/// The vehicle is no longer held for that robot, or is now held for another.
void RightOfWay::on_change(bool held, RobotId held_for) {
  const TimeNs now = onboard_.now();
  const bool holds = yield_state_.holds(), same = held && holds && yield_state_.with() == held_for;
  if (held && !same) {
    onboard_.recorder.write(now,
                            event::Team{.action = event::TeamAction::go_on, .robot = number_of(held_for)});
    failed_places_.clear();
    parts_.path.block();  // a new path is needed from here
    if (!holds) parts_.path.stop(now);
  }
  if (holds && !same) {
    onboard_.recorder.write(
        now, event::Team{.action = event::TeamAction::give_way, .robot = number_of(yield_state_.with())});
    parts_.goals.drop_next(GoalFate::superseded, "another vehicle is in the way", now);
    parts_.path.block();
    parts_.path.stop(now);
  }
}

void RightOfWay::note_failed(const Vec3& place) {
  const bool known = std::any_of(failed_places_.begin(), failed_places_.end(), [&](const Vec3& known_one) {
    return (known_one - place).norm() < kAtWaitingPlace_m;
  });
  if (!known) failed_places_.push_back(place);
}

/// To where the one that it gives way to gets by, or before it back along the way come; clear of all others.
void RightOfWay::make_room(const std::vector<Neighbour>& others) {
  if (planning_) return;
  planning_ = true;
  const RobotId with = yield_state_.with();
  const bool crowd = std::any_of(others.begin(), others.end(), [&](const Neighbour& o) {
    return o.robot != with && o.phase != TeamPhase::aside &&
           (o.position - onboard_.flight.state().position).norm() < kCrowd_m;
  });
  RoomQuery query;
  query.others = others;
  for (Neighbour& o : query.others) o.position += seconds(kAsideBudget) * o.velocity_mps;
  query.flown = parts_.flown_path.points();
  query.failed = failed_places_;
  query.separation_m = team_.options().separation_m / 2;
  const TimeNs begun = onboard_.now();
  onboard_.map.job(
      "make room", kAsideBudget,
      [this, query, start = parts_.path.start_at_stop(begun + kAsideBudget)](Explorer& explorer) {
        return find_room(explorer, query, start);
      },
      [this, begun, with, crowd](const Room& room) {
        planning_ = false;
        if (yield_state_.with() == with && !parts_.path.braked_since(begun)) on_room(room, crowd);
      });
}

RightOfWay::Room RightOfWay::find_room(Explorer& explorer, RoomQuery query, const RouteStart& start) const {
  const Vec3& from = start.committed.points.back();
  query.from = from;
  Room room;
  room.waiting_place = explorer.find_waiting_place(query);
  if (!room.waiting_place || (room.waiting_place->place - from).norm() < 1e-3) return room;
  const Path path = explorer.plan_to(from, room.waiting_place->place);
  if (path.found())
    room.route = make_route(explorer.map(), onboard_.options, onboard_.vehicle, start, path, {});
  else
    room.waiting_place.reset();
  return room;
}

void RightOfWay::on_room(const Room& room, bool crowd) {
  const TimeNs now = onboard_.now();
  if (!room.waiting_place) {
    yield_state_.no_room(now, crowd);
    onboard_.recorder.write(
        now, event::Team{.action = event::TeamAction::no_room, .robot = number_of(yield_state_.with())});
    return;
  }
  waiting_place_ = *room.waiting_place;
  yield_state_.set_out();
  onboard_.recorder.write(now, event::Team{event::TeamAction::make_room, number_of(yield_state_.with()),
                                           waiting_place_.place, waiting_place_.keeps_passage_open});
  if (room.route.path.found()) return parts_.path.follow(room.route, now);
  still_.wait(now);  // it waits where it stands: only now the others can begin to pass
}

}  // namespace karst::core
