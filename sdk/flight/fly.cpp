#include "sdk/flight/fly.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "core_stack/common/error.h"
#include "core_stack/common/stall_watch.h"
#include "sdk/evaluation/metrics/metrics.h"
#include "sdk/evaluation/team/run_ending.h"
#include "sdk/flight/known_map.h"
#include "sdk/flight/known_survey.h"
#include "sdk/flight/real_time.h"
#include "sdk/flight/recorded_vehicle.h"
#include "sdk/flight/run_files.h"
#include "sdk/flight/status_line.h"
#include "sdk/flight/team_metrics.h"
#include "sdk/flight/timing.h"
#include "sdk/host/serialization/request_log.h"
#include "sdk/terminal/terminal.h"

namespace karst::flight {
namespace {

namespace fs = std::filesystem;

// The time that a step or job may take before the flight is aborted: longer than any decision or plan takes
// on any machine. In real time Lockstep watches.
constexpr std::chrono::seconds kStallInLockstep{600};

/// Ends the process because the step or job `running` does not return: objects in use by the hanging code
/// cannot be destroyed. The record is complete up to the last second. Even if nobody reads what it prints,
/// the process ends within a second: the vehicle comes down only when it gets no more commands.
[[noreturn]] void end_stalled(const std::string& running, const fs::path& run_dir) {
  std::signal(SIGALRM, SIG_DFL);
  alarm(1);
  std::fprintf(stderr,
               "karst: %s does not return: the flight is given up\nkarst: its record ends early: %s\n",
               running.empty() ? "a step" : ("\"" + running + "\"").c_str(), run_dir.c_str());
  std::_Exit(kNotAsMeant);
}

void refuse_for_team(const FlightRequest& request) {
  if (request.clock == core::Clock::real_time)
    throw core::InputError("karst fly", "--real-time",
                           "a team flies in lockstep only: its vehicles share a world");
  if (request.record_requests)
    throw core::InputError("karst fly", "--record-requests", "of a team no requests are recorded");
  if (request.listener)
    throw core::InputError("karst fly", "--live", "a team cannot be followed: fly a single vehicle");
}

void refuse_second_policy(const Mission& mission, const FlightRequest& request) {
  if (!mission.later && !mission.review) return;
  if (mission.later && mission.review)
    throw core::InputError(mission.file, "policy.later",
                           "a flight changes its policy once: leave this or policy.auto.reconsider out");
  const char* key = mission.later ? "policy.later" : "policy.auto.reconsider";
  if (is_team(mission)) throw core::InputError(mission.file, key, "is for a single vehicle, not for a team");
  if (request.record_requests)
    throw core::InputError("karst fly", "--record-requests",
                           "records one policy: leave it or " + std::string(key) + " out");
  if (mission.review && request.clock == core::Clock::real_time)
    throw core::InputError(
        "karst fly", "--real-time",
        "describing the map takes a second in which no decision is made: leave " + std::string(key) + " out");
}

/// The mission with another policy.
Mission with_policy(Mission mission, const LaterPolicy& later) {
  mission.policy = later.policy;
  mission.policy_parameters = later.parameters;
  mission.file += ": policy.later";  // where the parameters are read, for messages
  return mission;
}

/// Warns if the radio's range differs from the range the robots assume when they choose landing sites.
void compare_radio_with_belief(const Mission& mission) {
  const std::string believed = mission.resolved.get("homing.landing.link.range", "");
  const std::string real = mission.resolved.get("radio.range", believed);
  if (believed != real)
    print_error(
        "karst: note: the radio reaches %s (radio.range), and the robots land as if it were %s "
        "(homing.landing.link.range)\n",
        real.c_str(), believed.c_str());
}

/// What a flight in real time was granted, on a page.
std::string page_of(const RealTimeProcess& process, const ServiceManager& service, double hang_limit_s) {
  std::array<char, 200> more;
  std::snprintf(more.data(), more.size(),
                "  watchdog     karst ends if the loop hangs for %.1f s%s\n"
                "  record       on the disk within 2.5 s, if the disk keeps up\n",
                hang_limit_s,
                !service.listens()                ? ""
                : service.watchdog().count() == 0 ? "; systemd is told when it is ready"
                                                  : "; systemd gets signs of life, too");
  return "Real time:\n" + process.page() + more.data();
}

}  // namespace

/// The objects of a flight, in order of construction; they are destroyed in reverse order.
struct MissionFlight::Running {
  ServiceManager service = ServiceManager::of_environment();
  std::optional<RealTimeProcess> real_time;
  std::optional<RunClaim> claim;
  std::vector<std::unique_ptr<RunClaim>> own_claims;  // of a team's members, in folders below
  std::vector<std::unique_ptr<core::Recorder>> recorders;
  Vehicles vehicles;
  std::vector<std::unique_ptr<RecordedVehicle>> recorded;  // with record.scans
  std::optional<host::RecordingPolicy> recording;
  std::optional<SuccessivePolicies> successive;
  std::optional<TeamFlight> team;
  std::optional<Lockstep> lockstep;
};

MissionFlight::MissionFlight(const Mission& mission, const FlightRequest& request)
    : mission_(with_earlier_map(with_survey(mission,
                                            [&](const std::string& note) {
                                              if (request.notes) print_error("note: %s\n", note.c_str());
                                            }))),
      request_(request),
      members_(missions_of_members(mission_)) {
  if (is_team(mission_)) refuse_for_team(request_);
  refuse_second_policy(mission_, request_);
  loaded_ = load_policies(members_, request_);
  if (mission_.later)
    later_ =
        host::load_policy(policy_choice(with_policy(mission_, *mission_.later), request_, loaded_.isolation));
  if (is_team(mission_)) key_ = radio_key(mission_);
}

MissionFlight::~MissionFlight() = default;

boost::property_tree::ptree MissionFlight::as_asked(const Mission& mission) const {
  const host::HostedPolicy& policy = *loaded_.policies.front();
  return recorded_mission(mission, policy.parameters(), policy.version());
}

/// As asked, and with the isolation that the policy has on this machine.
boost::property_tree::ptree MissionFlight::as_flown(const Mission& mission) const {
  boost::property_tree::ptree tree = as_asked(mission);
  tree.put("policy.isolation", core::name_of(loaded_.isolation));
  return tree;
}

void MissionFlight::check(const fs::path& mission_file) const {
  make_vehicles(mission_, members_, "", request_.clock);  // checks the cave and the starts
  write_mission(mission_file, as_asked(mission_));
}

/// All errors before take-off occur here; the files written so far are then removed.
void MissionFlight::prepare(const std::atomic<bool>& interrupted) {
  const fs::path& run_dir = request_.run_dir;
  running_ = std::make_unique<Running>();
  Running& r = *running_;
  r.claim.emplace(run_dir, request_.old_run);
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const fs::path own = member_run_dir(run_dir, mission_, i);
    if (own != run_dir) r.own_claims.push_back(std::make_unique<RunClaim>(own));
    r.recorders.push_back(std::make_unique<core::Recorder>(own, request_.clock == core::Clock::real_time
                                                                    ? core::Durability::survives_a_power_cut
                                                                    : core::Durability::survives_a_crash));
    r.recorders.back()->set_listener(request_.listener);
  }
  r.vehicles = make_vehicles(mission_, members_, run_dir, request_.clock);
  if (mission_.record.scans)
    for (std::size_t i = 0; i < members_.size(); ++i)
      r.recorded.push_back(std::make_unique<RecordedVehicle>(r.vehicles[i], *r.recorders[i]));
  write_mission(run_dir / "mission.info", as_flown(mission_));
  if (r.vehicles.world) {
    for (std::size_t i = 0; i < members_.size(); ++i) {
      members_[i].start = r.vehicles.world->start_of(i);
      write_mission(member_run_dir(run_dir, mission_, i) / "mission.info", as_flown(members_[i]));
    }
  } else if (interrupted) {
    throw core::InputError("karst fly", "", "stopped by the operator before take-off");
  }
  r.claim->keep();
  for (const auto& own : r.own_claims) own->keep();
  for (std::size_t i = 0; i < loaded_.outputs.size(); ++i)
    loaded_.outputs[i]->write_to(member_run_dir(run_dir, mission_, i) / host::kPolicyOutputName);
}

std::vector<Seat> MissionFlight::seats() const {
  Running& r = *running_;
  std::vector<Seat> seats;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    Seat seat{&r.vehicles[i], loaded_.policies[i].get(), r.recorders[i].get()};
    if (!r.recorded.empty()) seat.vehicle = r.recorded[i].get();
    if (r.recording) seat.policy = &*r.recording;
    if (r.successive) seat.policy = &*r.successive;
    if (r.team) {
      seat.teamwork = &r.team->teamwork(i);
      seat.starts_at = r.team->starts_at(i);
    }
    seats.push_back(seat);
  }
  return seats;
}

RealTime MissionFlight::real_time() {
  const RealTimeProcess& process = *running_->real_time;
  RealTime how;
  how.setup.on_lane_thread = [&process](core::Lane lane) { process.prepare_thread(role_of(lane)); };
  how.on_loop_thread = [&process] { process.prepare_thread(ThreadRole::loop); };
  how.on_landed = [this, &process] {
    in_the_air_ = false;
    if (!process.release_thread() && request_.notes)
      print_error("note: the record is completed with the priority of the flight\n");
  };
  how.on_watch_thread = [&process] { process.prepare_thread(ThreadRole::watchdog); };
  how.hang_limit = std::chrono::milliseconds(static_cast<long>(1e3 * mission_.real_time.hang_limit_s));
  how.on_hang = [this](const std::string& running) { end_stalled(running, request_.run_dir); };
  return how;
}

void MissionFlight::assemble() {
  Running& r = *running_;
  LockstepOptions how{request_.threads, request_.clock};
  if (request_.clock == core::Clock::real_time) {
    r.real_time.emplace(mission_.real_time, mission_.file);
    how.real_time = real_time();
  }
  if (r.vehicles.world) {
    r.team.emplace(TeamFlightSetup{mission_.core, mission_.faults, static_cast<std::uint64_t>(mission_.seed),
                                   *key_, request_.run_dir},
                   *r.vehicles.world);
    how.linger = core::from_seconds(mission_.core.team.linger_s);
    r.lockstep.emplace(r.team->options(), how, seats(), &*r.team);
  } else {
    if (!mission_.policy_selection.empty())
      r.recorders.front()->write(0, core::event::Selection{mission_.policy, mission_.policy_selection});
    host::HostedPolicy& policy = *loaded_.policies.front();
    if (request_.record_requests)
      r.recording.emplace(policy, request_.run_dir / host::kRequestLogName,
                          host::RequestLogHeader{policy.name(), policy.version(), policy_seed(mission_),
                                                 policy.parameters()});
    if (mission_.later || mission_.review)
      r.successive.emplace(
          policy, core::from_seconds(mission_.later ? mission_.later->after_s : mission_.review->after_s),
          [this](const core::DecisionRequest& request) { return successor(request); });
    r.lockstep.emplace(mission_.core, how, seats());
  }
}

/// The policy that takes over now. What a review chose is kept as policy.later, so that the flight can be
/// repeated without it.
Successor MissionFlight::successor(const core::DecisionRequest& request) {
  if (later_) return {std::move(later_), mission_.later->selection};
  auto [chosen, reason] = mission_.review->choose(*request.map);
  if (!chosen) return {nullptr, reason};
  const host::HostedPolicy& first = *loaded_.policies.front();
  try {
    std::unique_ptr<host::HostedPolicy> next =
        host::load_policy(policy_choice(with_policy(mission_, *chosen), request_, loaded_.isolation));
    if (next->name() == first.name() && next->parameters() == first.parameters()) return {nullptr, reason};
    chosen->parameters = next->parameters();
    mission_.later = std::move(chosen);
    return {std::move(next), reason};
  } catch (const std::exception& e) {  // the first policy goes on
    return {nullptr, e.what()};
  }
}

/// Returns when the flight is over, by its clock.
core::TimeNs MissionFlight::run(const std::atomic<bool>& interrupted) {
  const Running& r = *running_;
  if (r.real_time && request_.notes)
    print_error("%s", page_of(*r.real_time, r.service, mission_.real_time.hang_limit_s).c_str());
  r.service.notify("READY=1\nSTATUS=flying");
  std::optional<StatusLine> line;
  if (request_.status_line) line.emplace(members_.size(), request_.clock);
  std::vector<const core::Executive*> executives;
  for (std::size_t i = 0; i < members_.size(); ++i) executives.push_back(&running_->lockstep->executive(i));
  std::optional<core::StallWatch> stall;
  if (request_.clock == core::Clock::lockstep)
    stall.emplace(std::move(executives), kStallInLockstep,
                  [this](const std::string& running) { end_stalled(running, request_.run_dir); });
  in_the_air_ = true;
  const core::TimeNs end = running_->lockstep->run([&](core::TimeNs now, const auto& all) {
    if (line) line->show(now, all);
    return !interrupted.load();
  });
  in_the_air_ = false;
  if (line) line->end();
  r.service.notify("STATUS=evaluating the flight");
  return end;
}

nlohmann::ordered_json MissionFlight::finish_alone(FlightOutcome& outcome, double wall_s) const {
  const fs::path& run_dir = request_.run_dir;
  const core::MissionResult& result = *running_->lockstep->state(0).ended;
  const SeatState& state = running_->lockstep->state(0);
  const core::Executive& executive = running_->lockstep->executive(0);
  if (running_->real_time) {
    const RealTimeTiming timing{running_->real_time->grants(), state.degraded};
    write_timing(run_dir, executive, wall_s, &timing);
    outcome.real_time.emplace();
    if (const auto control = executive.punctuality().find("control");
        control != executive.punctuality().end())
      outcome.real_time->control = control->second;
    outcome.real_time->degraded = state.degraded;
  } else {
    write_timing(run_dir, executive, wall_s);
  }
  const nlohmann::json metrics = finish_run(
      run_dir, {mission_.cave, mission_.start, request_.report, request_.cave_cache, mission_.mesh});
  outcome.endings = evaluation::read_endings(run_dir);
  outcome.record_problem = result.record_problem;
  return nlohmann::ordered_json(metrics);
}

nlohmann::ordered_json MissionFlight::finish_members(FlightOutcome& outcome, double wall_s) const {
  const fs::path& run_dir = request_.run_dir;
  const Finishing how{mission_.cave, mission_.start, request_.report, request_.cave_cache, mission_.mesh};
  // First writes the metrics that the flight itself knows, so that they are kept if the evaluation is killed,
  // for example for lack of memory.
  std::vector<nlohmann::json> own(members_.size());
  evaluation::write_metrics(run_dir, team_metrics(mission_, *outcome.team, own));
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const fs::path folder = member_run_dir(run_dir, mission_, i);
    write_timing(folder, running_->lockstep->executive(i), wall_s);
    own[i] = finish_run(folder, how);
  }
  nlohmann::ordered_json metrics = team_metrics(mission_, *outcome.team, own);
  evaluation::write_metrics(run_dir, metrics);
  write_team_timing(run_dir, {outcome.team->duration_s, wall_s, request_.threads});
  finish_team(run_dir, how, metrics);
  outcome.endings = evaluation::read_endings(run_dir);
  outcome.record_problem = outcome.team->record_problem;
  return metrics;
}

std::vector<PolicyPrinted> MissionFlight::printed() const {
  std::vector<PolicyPrinted> all;
  for (std::size_t i = 0; i < loaded_.outputs.size(); ++i) {
    const host::PolicyOutput& output = *loaded_.outputs[i];
    if (!output.empty())
      all.push_back({i, loaded_.policies[i]->name(),
                     member_run_dir(request_.run_dir, mission_, i) / host::kPolicyOutputName,
                     output.before_break(), output.last_lines(), output.problem()});
  }
  return all;
}

FlightOutcome MissionFlight::fly(const std::atomic<bool>& interrupted) {
  if (is_team(mission_) && request_.notes) compare_radio_with_belief(mission_);
  prepare(interrupted);
  assemble();
  FlightOutcome outcome;
  // While the vehicle flies, the loop must live; before and after, the process.
  const ServiceWatchdog signs_of_life(
      running_->service,
      [this, before = std::uint64_t{0}]() mutable {
        const std::uint64_t events = running_->lockstep->executive(0).events();
        const bool lives = !in_the_air_ || events != before;
        before = events;
        return lives;
      },
      [this] {
        if (running_->real_time) running_->real_time->prepare_thread(ThreadRole::watchdog);
      });
  try {
    const auto begin = std::chrono::steady_clock::now();
    const core::TimeNs end = run(interrupted);
    if (mission_.review && mission_.later)
      write_mission(request_.run_dir / "mission.info", as_flown(mission_));
    if (running_->team) outcome.team = running_->team->result(*running_->lockstep, end);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    outcome.metrics =
        outcome.team ? finish_members(outcome, wall.count()) : finish_alone(outcome, wall.count());
  } catch (const std::exception& e) {  // such as a full disk: the flight still took place
    in_the_air_ = false;
    outcome.record_problem = e.what();
  }
  outcome.as_meant = outcome.record_problem.empty() && !outcome.endings.empty() &&
                     evaluation::joint_ending(outcome.endings).as_meant;
  outcome.printed = printed();
  return outcome;
}

bool MissionFlight::hangs() const {
  if (running_ && running_->successive && running_->successive->abandoned()) return true;
  return std::any_of(loaded_.policies.begin(), loaded_.policies.end(),
                     [](const auto& p) { return p->abandoned(); });
}

}  // namespace karst::flight
