#include "sdk/flight/lockstep.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>

namespace karst::flight {

using core::Phase;
using core::TimeNs;

namespace {

constexpr TimeNs kStep = 100 * core::kMillisecond;  // between two exchanges

}  // namespace

struct Lockstep::Vehicle {
  Vehicle(const Seat& s, int threads, const LockstepOptions& how)
      : seat(s), executive(threads, how.clock, how.real_time.setup) {}

  void fly_to(TimeNs time) {
    if (control->advance(time - seat.starts_at)) return;
    end(time);
  }
  void end(TimeNs time) {
    state.ended = control->end();
    state.ended_at = time;
    for (const auto& [relief, name] : names_of(core::Relief{}))
      if (const int times = control->load().times(relief); times > 0)
        state.degraded.emplace_back(relief, times);
  }

  Seat seat;
  core::Executive executive;  // its clock begins when the vehicle is switched on
  std::unique_ptr<core::MissionControl> control;
  SeatState state;
};

Lockstep::Lockstep(const core::CoreOptions& options, const LockstepOptions& how,
                   const std::vector<Seat>& seats, StepHooks* hooks)
    : options_(options), how_(how), hooks_(hooks) {
  const int threads_each = seats.size() == 1 ? how.threads : 1;
  for (const Seat& seat : seats) vehicles_.push_back(std::make_unique<Vehicle>(seat, threads_each, how));
}

Lockstep::~Lockstep() = default;

TimeNs Lockstep::run(const FlightWatch& watch) {
  if (how_.clock == core::Clock::real_time)
    run_in_real_time(watch);
  else
    run_in_steps(watch);
  return now_;
}

/// No vehicle waits for another: the whole flight is one step. After it the watch is patient: a large map
/// takes long to write.
void Lockstep::run_in_real_time(const FlightWatch& watch) {
  Vehicle& vehicle = *vehicles_.front();
  const RealTime& how = how_.real_time;
  vehicle.control = std::make_unique<core::MissionControl>(options_, *vehicle.seat.vehicle, vehicle.executive,
                                                           *vehicle.seat.policy, *vehicle.seat.recorder);
  std::optional<core::StallWatch> stall;
  const auto allow = [&](std::chrono::milliseconds limit) {
    stall.reset();
    if (how.on_hang)
      stall.emplace(std::vector<const core::Executive*>{&vehicle.executive}, limit, how.on_hang,
                    how.on_watch_thread);
  };
  allow(how.hang_limit);
  if (how.on_loop_thread) how.on_loop_thread();
  vehicle.control->fly([&](const core::MissionStatus& status) {
    vehicle.state.status = status;
    return watch(status.time, {status});
  });
  allow(how.end_limit);
  if (how.on_landed) how.on_landed();
  now_ = vehicle.executive.now();
  vehicle.end(now_);
}

void Lockstep::run_in_steps(const FlightWatch& watch) {
  bool go_on = true;
  const auto attempt = [&](const auto& what) {
    const auto end_in_order = [&](const char* reason) {
      if (!hooks_) throw;  // a single vehicle lands by itself: a failure here precedes its take-off
      go_on = false;
      land_all(reason);
    };
    try {
      what();
    } catch (const std::exception& e) {  // no vehicle may be left in the air
      end_in_order(e.what());
    } catch (...) {
      end_in_order("an unknown exception");
    }
  };
  for (; !over(); now_ += kStep) {
    attempt([&] {
      if (go_on)
        for (std::size_t i = 0; i < vehicles_.size(); ++i)
          if (now_ == starts_at(i) && !vehicles_[i]->state.stopped) start(i, watch);
      fly_all_to(now_ + kStep);
      if (hooks_) hooks_->exchange(*this, now_ + kStep);
    });
    attempt([&] { note_phases(); });  // even after a failure: it detects which vehicles have landed
    attempt([&] {
      if (hooks_) hooks_->inject_faults(*this, now_ + kStep);
    });
    attempt([&] {
      if (hooks_ && now_ % core::kSecond == 0 && go_on) go_on = ask(watch, now_);
    });
  }
}

void Lockstep::start(std::size_t i, const FlightWatch& watch) {
  Vehicle& vehicle = *vehicles_[i];
  const Seat& seat = vehicle.seat;
  vehicle.control = std::make_unique<core::MissionControl>(options_, *seat.vehicle, vehicle.executive,
                                                           *seat.policy, *seat.recorder, seat.teamwork);
  vehicle.state.flying = true;
  vehicle.control->begin([this, &vehicle, &watch](const core::MissionStatus& status) {
    vehicle.state.status = status;
    if (!hooks_) return watch(status.time, {status});
    return !vehicle.state.stopped;
  });
  if (hooks_) hooks_->on_start(i, seat.starts_at);
}

void Lockstep::land(std::size_t vehicle, const char* reason) {
  Vehicle& v = *vehicles_.at(vehicle);
  v.state.stopped = true;
  if (v.control) v.control->land_now(reason);
}

void Lockstep::land_all(const char* reason) {
  for (std::size_t i = 0; i < vehicles_.size(); ++i) land(i, reason);
}

/// Advances each vehicle independently, on up to `threads` threads.
void Lockstep::fly_all_to(TimeNs time) {
  std::vector<Vehicle*> flying;
  for (const auto& v : vehicles_)
    if (v->control && !v->state.ended) flying.push_back(v.get());
  std::atomic<std::size_t> next{0};
  std::vector<std::exception_ptr> failures(flying.size());
  const auto work = [&] {
    for (std::size_t i = next++; i < flying.size(); i = next++) try {
        flying[i]->fly_to(time);
      } catch (...) {
        failures[i] = std::current_exception();
      }
  };
  {
    const auto most = static_cast<std::size_t>(std::max(1, how_.threads));
    std::vector<std::jthread> helpers;
    for (std::size_t n = 1; n < std::min(most, flying.size()); ++n) helpers.emplace_back(work);
    work();
  }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

void Lockstep::note_phases() {
  for (std::size_t i = 0; i < vehicles_.size(); ++i) {
    Vehicle& v = *vehicles_[i];
    const Phase phase = v.control ? v.control->phase() : v.state.phase;
    if (core::traits_of(v.state.phase).explores) v.state.explored_for += kStep;
    if (phase == v.state.phase || (phase == Phase::done && !v.state.ended))
      continue;  // it ends with its next step
    v.state.phase = phase;
    if (v.control) v.state.homing_reason = v.control->homing_reason();
    if (hooks_) hooks_->on_phase(*this, i, now_ + kStep);
    if (phase != Phase::done) continue;
    v.state.flying = false;
    if (hooks_) v.control.reset();  // the others fly on without its maps
  }
}

bool Lockstep::ask(const FlightWatch& watch, TimeNs now) {
  std::vector<core::MissionStatus> all;
  for (const auto& v : vehicles_) all.push_back(v->state.status);
  const bool go_on = watch(now, all);
  for (const auto& v : vehicles_) v->state.stopped |= !go_on;
  return go_on;
}

/// Whether all vehicles have landed, and the time for their last messages has passed.
bool Lockstep::over() const {
  TimeNs last = 0;
  for (const auto& v : vehicles_) {
    if (!v->state.ended_at && v->state.stopped && !v->control) continue;  // it never started
    if (!v->state.ended_at) return false;
    last = std::max(last, *v->state.ended_at);
  }
  return now_ >= last + how_.linger;
}

const SeatState& Lockstep::state(std::size_t vehicle) const { return vehicles_.at(vehicle)->state; }
TimeNs Lockstep::starts_at(std::size_t vehicle) const { return vehicles_.at(vehicle)->seat.starts_at; }
const core::Executive& Lockstep::executive(std::size_t vehicle) const {
  return vehicles_.at(vehicle)->executive;
}

}  // namespace karst::flight
