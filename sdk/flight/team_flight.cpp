#include "sdk/flight/team_flight.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <nlohmann/json.hpp>

#include "core_stack/common/json_point.h"
#include "core_stack/mission/recording/object_log.h"

namespace karst::flight {

using core::RobotId;
using core::TimeNs;
using core::Vec3;

namespace {

constexpr TimeNs kBaseLogPeriod = 5 * core::kSecond;

core::CoreOptions for_team(core::CoreOptions o) {
  o.mission.home_margin = core::homing_margin(o.homing);  // one rule for all strategies
  o.homing.landing.landing_speed_mps = o.mission.landing_speed_mps;
  return o;
}

RobotId id_of(std::size_t robot) { return static_cast<RobotId>(robot + 1); }

/// A dropped node acts as a team node that stands at its position, which it reports like a landed robot.
std::unique_ptr<core::TeamNode> node_of(const core::DroppedNode& dropped, const core::CoreOptions& options,
                                        const core::TeamSetup& setup, TimeNs now) {
  const auto& [id, drop] = dropped;
  auto node =
      std::make_unique<core::TeamNode>(id, options.team, options.homing, setup.base, setup.seed, setup.key);
  core::TeamState lies;
  lies.position = drop.ground;
  lies.phase = core::TeamPhase::relay;
  node->set_state(lies);
  core::TreeFacts above;
  above.nodes = {{{id, 1}, core::NodeKind::communication, core::to_centimetres(drop.from)}};
  node->publish(above);
  node->publish(core::LandingClaim{now, drop.ground, drop.from, core::LandingClaim::State::landed});
  return node;
}

}  // namespace

TeamFlight::TeamFlight(const TeamFlightSetup& setup, sim::SimulatedWorld& world)
    : options_(for_team(setup.options)),
      faults_(setup.faults),
      setup_{world.base(), setup.seed, setup.key},
      world_(world),
      base_(core::kBase, options_.team, options_.homing, setup_.base, setup_.seed, setup_.key),
      base_tree_(options_.homing.tree, core::cruise_speed_mps(options_.motion)),
      log_(setup.run_dir) {
  const auto robots = static_cast<std::size_t>(options_.team.robots);
  base_tree_.insert_communication({core::kBase, 1}, core::to_centimetres(setup_.base), 0,
                                  [](const Vec3&, const Vec3&) { return false; });
  log_.event(0, "team",
             {{"robots", robots},
              {"strategy", core::name_of(options_.team.strategy)},
              {"base", core::list(setup_.base)},
              {"reach", options_.homing.landing.link.range_m}});
  for (std::size_t i = 0; i < robots; ++i)
    members_.push_back(std::make_unique<core::TeamMember>(id_of(i), options_, world.robot(i).description(),
                                                          setup_, starts_at(i), world.port(i)));
  struck_.resize(robots);
}

TimeNs TeamFlight::starts_at(std::size_t robot) const {
  return core::from_seconds(std::round(options_.team.stagger_s)) * static_cast<TimeNs>(robot);
}

void TeamFlight::on_start(std::size_t robot, TimeNs now) {
  log_.event(now, "start", {{"robot", id_of(robot)}});
}

void TeamFlight::exchange(Lockstep& flight, TimeNs now) {
  place_nodes(now);
  world_.meet(now);
  talk(flight, now);
}

void TeamFlight::place_nodes(TimeNs now) {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const std::optional<core::DroppedNode> dropped = members_[i]->drop_due_node();
    if (!dropped) continue;
    nodes_.push_back(node_of(*dropped, options_, setup_, now));
    log_.event(now, "drop",
               {{"robot", id_of(i)}, {"node", dropped->id}, {"ground", core::list(dropped->drop.ground)}});
  }
}

/// All radios transmit before any receives. A robot whose radio throws lands; the others continue.
void TeamFlight::talk(Lockstep& flight, TimeNs now) {
  const auto attempt = [&](RobotId radio, const auto& exchange) {
    try {
      exchange();
    } catch (const std::exception& e) {
      if (radio >= 1 && radio <= members_.size()) flight.land(radio - 1u, e.what());
      log_.event(now, "error", {{"robot", radio}, {"reason", e.what()}});
    }
  };
  const auto radio_of = [&](const core::TeamNode& member) -> core::RadioPort& {
    return world_.radio(member.self());
  };
  attempt(core::kBase, [&] { core::transmit(base_, radio_of(base_), now); });
  for (const auto& m : members_) attempt(m->id(), [&] { m->transmit(now); });
  for (const auto& n : nodes_) attempt(n->self(), [&] { core::transmit(*n, radio_of(*n), now); });
  attempt(core::kBase, [&] { core::receive(base_, radio_of(base_), now); });
  for (const auto& m : members_) attempt(m->id(), [&] { m->receive(now); });
  for (const auto& n : nodes_) attempt(n->self(), [&] { core::receive(*n, radio_of(*n), now); });

  for (const auto& m : members_) object_log_.robot(now, m->node(), log_);
  object_log_.base(now, base_, log_);
  if (now % kBaseLogPeriod == 0) {
    log_base(now);
    log_.flush();
  }
}

void TeamFlight::log_base(TimeNs now) {
  base_tree_.apply(base_.take_facts());
  log_.base(now, base_);
  log_.tree(now, base_tree_);
}

void TeamFlight::on_phase(const Lockstep& flight, std::size_t robot, TimeNs now) {
  const SeatState& state = flight.state(robot);
  const bool done = state.phase == core::Phase::done;
  if (done && !state.ended->stands)
    world_.wreck(robot, state.ended->reason);  // its radio is silent from now on
  log_.event(now, "phase", {{"robot", id_of(robot)}, {"phase", core::name_of(state.phase)}});
  if (!done) return;
  const auto& claim = members_[robot]->node().landing_of(id_of(robot));
  log_.event(now, "end",
             {{"robot", id_of(robot)},
              {"outcome", core::name_of(state.ended->outcome)},
              {"reason", state.ended->reason},
              {"ground", claim ? core::list(claim->ground) : nlohmann::json()}});
}

void TeamFlight::inject_faults(const Lockstep& flight, TimeNs now) {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (struck_[i]) continue;
    const SeatState& state = flight.state(i);
    const bool in_the_air =
        state.flying && state.phase != core::Phase::standby && state.phase != core::Phase::takeoff;
    if (id_of(i) == faults_.lost_robot && in_the_air &&
        now - starts_at(i) >= core::from_seconds(faults_.lost_after_s)) {
      struck_[i] = true;
      world_.wreck(i, "lost, as team.lost_robot has it");
      log_.event(now, "lost", {{"robot", id_of(i)}});
    } else if (id_of(i) == faults_.silent_relay && state.ended_at &&
               now - *state.ended_at >= core::from_seconds(faults_.silent_after_s)) {
      struck_[i] = true;
      world_.silence(id_of(i));
      log_.event(now, "silent", {{"robot", id_of(i)}});
    }
  }
}

RobotResult TeamFlight::result_of(const Lockstep& flight, std::size_t robot, TimeNs now) const {
  const SeatState& state = flight.state(robot);
  const core::TeamNode& member = members_[robot]->node();
  const std::vector<RobotId> connected = base_.graph().connected(now);
  RobotResult r;
  r.mission = state.ended.value_or(
      core::MissionResult{core::MissionOutcome::aborted, "stopped by the operator before its start"});
  r.start_s = core::seconds(starts_at(robot));
  r.end_s = core::seconds(state.ended_at.value_or(now));
  r.exploration_time_s = core::seconds(state.explored_for);
  r.homing_reason = state.homing_reason;
  r.battery_left = state.status.battery ? state.status.battery->fraction_left : 1;  // full before its start
  r.connected = std::find(connected.begin(), connected.end(), member.self()) != connected.end();
  r.records = member.gossip().held(member.self()).first();
  r.records_at_base = base_.gossip().held(member.self()).first();
  return r;
}

/// Returns the total number of bytes on the air.
std::uint64_t TeamFlight::log_traffic(TimeNs now) {
  std::uint64_t bytes = 0;
  const auto note = [&](const core::TeamNode& member) {
    const sim::RadioTraffic traffic = world_.traffic(member.self());
    log_.traffic(now, member.self(), traffic, member.gossip().counts());
    bytes += traffic.bytes_sent;
  };
  note(base_);
  for (const auto& m : members_) note(m->node());
  for (const auto& n : nodes_) note(*n);
  return bytes;
}

TeamResult TeamFlight::result(const Lockstep& flight, TimeNs now) {
  TeamResult out;
  out.duration_s = core::seconds(now);
  for (std::size_t i = 0; i < members_.size(); ++i) {
    out.robots.push_back(result_of(flight, i, now));
    if (out.record_problem.empty()) out.record_problem = out.robots.back().mission.record_problem;
  }
  log_base(now);
  if (!base_.objects().empty())
    log_.event(now, "objects", {{"known", core::list_of(core::merged(base_.objects()))}});
  out.bytes_on_air = log_traffic(now);
  log_.flush();
  try {
    world_.finish();
  } catch (const std::exception& e) {  // such as a full disk: the flight still took place
    if (out.record_problem.empty()) out.record_problem = e.what();
  }
  return out;
}

}  // namespace karst::flight
