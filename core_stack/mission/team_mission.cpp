#include "core_stack/mission/team_mission.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <nlohmann/json.hpp>
#include <thread>

#include "core_stack/mission/json_point.h"

namespace karst::core {
namespace {

constexpr TimeNs kStep = 100 * kMillisecond;  // between two exchanges
constexpr TimeNs kBaseLogPeriod = 5 * kSecond;

CoreOptions for_team(CoreOptions o) {
  o.mission.home_margin = homing_margin(o.homing);  // one rule, whatever the strategy
  o.homing.landing.landing_speed_mps = o.mission.landing_speed_mps;
  return o;
}

}  // namespace

struct TeamMission::Robot {
  Robot(RobotId number, const CoreOptions& options, const VehicleDescription& vehicle, const Vec3& base,
        std::uint64_t seed, const MissionKey& key)
      : id(number),
        starts_at(from_seconds(std::round(options.team.stagger_s)) * (number - 1)),
        executive(1),
        mate(id, options.team, options.homing, base, seed, key),
        homing(id, options.team, options.homing, base, options.planning, options.motion, vehicle.radius_m),
        teamwork(mate, homing, options.team, starts_at) {
    TeamState waiting;
    waiting.position = vehicle.T_world_start.position;
    teamwork.report(waiting, -starts_at);
  }

  RobotId id;
  TimeNs starts_at;
  Executive executive;  // its clock begins when it is switched on
  Teammate mate;
  RelayHoming homing;
  Teamwork teamwork;
  std::unique_ptr<MissionControl> control;  // while it flies
  MissionStatus status;
  bool stopped = false;  // by the operator
  std::optional<MissionResult> ended;
  std::optional<TimeNs> ended_at;
  Phase phase = Phase::standby;  // as last noted
  TimeNs explored_for = 0;
  RobotId nodes_dropped = 0;
  std::string homing_reason;
  bool silent = false;
};

TeamMission::TeamMission(const CoreOptions& options, TeamVehicles& vehicles,
                         const std::vector<TeamSeat>& seats, std::uint64_t seed, const MissionKey& key,
                         const std::filesystem::path& run_dir, int threads)
    : options_(for_team(options)),
      vehicles_(vehicles),
      seats_(seats),
      seed_(seed),
      key_(key),
      threads_(std::max(1, threads)),
      base_(kBase, options_.team, options_.homing, vehicles.base(), seed, key),
      base_tree_(options_.homing.tree, cruise_speed_mps(options_.motion)),
      log_(run_dir) {
  base_tree_.insert_communication({kBase, 1}, to_centimetres(vehicles.base()), 0,
                                  [](const Vec3&, const Vec3&) { return false; });
  log_.event(0, "team",
             {{"robots", seats.size()},
              {"strategy", options_.team.strategy},
              {"base", list(vehicles.base())},
              {"reach", options_.homing.landing.link.range_m}});
  for (std::size_t i = 0; i < seats.size(); ++i)
    robots_.push_back(std::make_unique<Robot>(static_cast<RobotId>(i + 1), options_,
                                              vehicles.robot(i).description(), vehicles.base(), seed, key));
}

TeamMission::~TeamMission() = default;

TeamResult TeamMission::run(const TeamWatch& watch) {
  TimeNs now = 0;
  bool go_on = true;
  const auto end_in_order = [&](const char* reason) {
    go_on = false;
    for (const auto& robot : robots_) land(*robot, reason);
  };
  const auto attempt = [&](const auto& step) {
    try {
      step();
    } catch (const std::exception& e) {  // none of them may be left in the air
      end_in_order(e.what());
    } catch (...) {
      end_in_order("an unknown exception");
    }
  };
  for (; !over(now); now += kStep) {
    attempt([&] { advance(now, go_on); });
    attempt([&] { note_phases(now + kStep); });  // whatever else fails: it finds out who has come down
    attempt([&] { strike(now + kStep); });
    attempt([&] {
      if (now % kSecond == 0 && go_on) go_on = ask(watch, now);
    });
  }
  return result(now);
}

/// By one step; `starting`: robots whose time has come take off.
void TeamMission::advance(TimeNs now, bool starting) {
  for (const auto& robot : robots_)
    if (now == robot->starts_at && starting && !robot->stopped) start(*robot);
  fly_all_to(now + kStep);
  place_nodes(now + kStep);
  vehicles_.meet(now + kStep);
  talk(now + kStep);
}

/// At once, or it does not start.
void TeamMission::land(Robot& robot, const char* reason) {
  robot.stopped = true;
  if (robot.control) robot.control->land_now(reason);
}

void TeamMission::start(Robot& robot) {
  const std::size_t i = robot.id - 1u;
  robot.control = std::make_unique<MissionControl>(options_, vehicles_.robot(i), robot.executive,
                                                   *seats_[i].policy, *seats_[i].recorder, &robot.teamwork);
  robot.control->begin([&robot](const MissionStatus& status) {
    robot.status = status;
    return !robot.stopped;
  });
  log_.event(robot.starts_at, "start", {{"robot", robot.id}});
}

/// Each robot by itself, on as many threads as there are.
void TeamMission::fly_all_to(TimeNs time) {
  std::vector<Robot*> flying;
  for (const auto& robot : robots_)
    if (robot->control && !robot->ended) flying.push_back(robot.get());
  std::atomic<std::size_t> next{0};
  std::vector<std::exception_ptr> failures(flying.size());
  const auto work = [&] {
    for (std::size_t i = next++; i < flying.size(); i = next++) try {
        fly(*flying[i], time);
      } catch (...) {
        failures[i] = std::current_exception();
      }
  };
  {
    std::vector<std::jthread> helpers;
    for (std::size_t n = 1; n < std::min<std::size_t>(static_cast<std::size_t>(threads_), flying.size()); ++n)
      helpers.emplace_back(work);
    work();
  }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

void TeamMission::fly(Robot& robot, TimeNs time) {
  if (robot.control->advance(time - robot.starts_at)) return;
  robot.ended = robot.control->end();
  robot.ended_at = time;
}

/// A node that was dropped is a teammate that stands where it lies, and as any that landed says so.
void TeamMission::place_nodes(TimeNs now) {
  for (const auto& robot : robots_) {
    const std::optional<NodeDrop> drop = robot->teamwork.take_drop();
    if (!drop) continue;
    const auto id = static_cast<RobotId>(static_cast<std::int64_t>(robots_.size()) +
                                         (robot->id - 1) * options_.team.nodes + ++robot->nodes_dropped);
    vehicles_.drop_node(robot->id - 1u, id);
    auto node = std::make_unique<Teammate>(id, options_.team, options_.homing, vehicles_.base(), seed_, key_);
    TeamState lies;
    lies.position = drop->ground;
    lies.phase = TeamPhase::relay;
    node->set_state(lies);
    TreeFacts above;
    above.nodes = {{{id, 1}, NodeKind::communication, to_centimetres(drop->from)}};
    node->publish(above);
    node->publish(LandingClaim{now, drop->ground, drop->from, LandingClaim::State::landed});
    nodes_.push_back(std::move(node));
    log_.event(now, "drop", {{"robot", robot->id}, {"node", id}, {"ground", list(drop->ground)}});
  }
}

/// What all say is on the air before anybody listens. Whose radio fails, lands; the others go on.
void TeamMission::talk(TimeNs now) {
  const auto each = [&](const auto& f) {
    const auto attempt = [&](Teammate& mate, std::size_t radio, Robot* robot) {
      try {
        f(mate, radio);
      } catch (const std::exception& e) {
        if (robot) land(*robot, e.what());
        log_.event(now, "error", {{"robot", radio}, {"reason", e.what()}});
      }
    };
    attempt(base_, 0, nullptr);
    for (const auto& robot : robots_) attempt(robot->mate, robot->id, robot.get());
    for (const auto& node : nodes_) attempt(*node, node->self(), nullptr);
  };
  each([&](Teammate& mate, std::size_t radio) {
    for (const Bytes& frame : mate.speak(now)) vehicles_.send(radio, frame, now);
  });
  each([&](Teammate& mate, std::size_t radio) {
    for (const auto& bytes : vehicles_.receive(radio, now)) mate.hear(bytes, now);
  });
  for (const auto& robot : robots_) object_log_.robot(now, robot->mate, log_);
  object_log_.base(now, base_, log_);
  if (now % kBaseLogPeriod == 0) {
    log_base(now);
    log_.flush();
  }
}

void TeamMission::log_base(TimeNs now) {
  base_tree_.apply(base_.take_facts());
  log_.base(now, base_);
  log_.tree(now, base_tree_);
}

void TeamMission::note_phases(TimeNs now) {
  for (const auto& robot : robots_) {
    const Phase phase = robot->control ? robot->control->phase() : robot->phase;
    if (robot->phase == Phase::explore) robot->explored_for += kStep;
    if (phase == robot->phase || (phase == Phase::done && !robot->ended))
      continue;  // it ends with its next step
    robot->phase = phase;
    if (robot->control) robot->homing_reason = robot->control->homing_reason();
    if (phase == Phase::done && !robot->ended->stands)
      vehicles_.wreck(robot->id - 1u, robot->ended->reason);  // what is left of it sends nothing
    log_.event(now, "phase", {{"robot", robot->id}, {"phase", name_of(phase)}});
    if (phase != Phase::done) continue;
    robot->control.reset();
    const auto& claim = robot->mate.landing_of(robot->id);
    log_.event(now, "end",
               {{"robot", robot->id},
                {"outcome", robot->ended->outcome},
                {"reason", robot->ended->reason},
                {"ground", claim ? list(claim->ground) : nlohmann::json()}});
  }
}

/// What the mission file has happen to the team, to see what it makes of it.
void TeamMission::strike(TimeNs now) {
  const TeamOptions& o = options_.team;
  for (const auto& robot : robots_) {
    const bool flies = robot->phase != Phase::standby && robot->phase != Phase::takeoff;
    if (robot->id == o.lost_robot && robot->control && !robot->silent && flies &&
        now - robot->starts_at >= from_seconds(o.lost_after_s)) {
      robot->silent = true;
      vehicles_.wreck(robot->id - 1u, "lost, as team.lost_robot has it");
      log_.event(now, "lost", {{"robot", robot->id}});
    }
    if (robot->id == o.silent_relay && robot->ended_at && !robot->silent &&
        now - *robot->ended_at >= from_seconds(o.silent_after_s)) {
      robot->silent = true;
      vehicles_.silence(robot->id);
      log_.event(now, "silent", {{"robot", robot->id}});
    }
  }
}

bool TeamMission::ask(const TeamWatch& watch, TimeNs now) {
  std::vector<MissionStatus> all;
  for (const auto& robot : robots_) all.push_back(robot->status);
  const bool go_on = watch(now, all);
  for (const auto& robot : robots_) robot->stopped |= !go_on;
  return go_on;
}

/// All have come down, and had the time to tell it.
bool TeamMission::over(TimeNs now) const {
  TimeNs last = 0;
  for (const auto& robot : robots_) {
    if (!robot->ended_at && robot->stopped && !robot->control) continue;  // it never started
    if (!robot->ended_at) return false;
    last = std::max(last, *robot->ended_at);
  }
  return now >= last + from_seconds(options_.team.linger_s);
}

TeamResult TeamMission::result(TimeNs now) {
  TeamResult out;
  for (const auto& robot : robots_)
    if (robot->ended && out.record_problem.empty()) out.record_problem = robot->ended->record_problem;
  out.duration_s = seconds(now);
  const std::vector<RobotId> connected = base_.graph().connected(now);
  for (const auto& robot : robots_) {
    RobotResult r;
    r.mission = robot->ended.value_or(MissionResult{"aborted", "stopped by the operator before its start"});
    r.start_s = seconds(robot->starts_at);
    r.end_s = seconds(robot->ended_at.value_or(now));
    r.exploration_time_s = seconds(robot->explored_for);
    r.homing_reason = robot->homing_reason;
    r.battery_left = robot->status.battery_fraction;
    r.connected = std::find(connected.begin(), connected.end(), robot->id) != connected.end();
    r.records = robot->mate.gossip().held(robot->id).first();
    r.records_at_base = base_.gossip().held(robot->id).first();
    out.robots.push_back(r);
  }
  log_base(now);
  if (!base_.objects().empty()) log_.event(now, "objects", {{"known", list_of(merged(base_.objects()))}});
  log_.traffic(now, kBase, vehicles_.traffic(kBase), base_.gossip().counts());
  for (const auto& robot : robots_)
    log_.traffic(now, robot->id, vehicles_.traffic(robot->id), robot->mate.gossip().counts());
  for (const auto& node : nodes_)
    log_.traffic(now, node->self(), vehicles_.traffic(node->self()), node->gossip().counts());
  for (std::size_t radio = 0; radio <= robots_.size(); ++radio)
    out.bytes_on_air += vehicles_.traffic(radio).bytes_sent;
  for (const auto& node : nodes_) out.bytes_on_air += vehicles_.traffic(node->self()).bytes_sent;
  log_.flush();
  try {
    vehicles_.finish();
  } catch (const std::exception& e) {  // a full disk: they flew all the same
    if (out.record_problem.empty()) out.record_problem = e.what();
  }
  return out;
}

const Executive& TeamMission::executive(std::size_t robot) const { return robots_.at(robot)->executive; }

}  // namespace karst::core
