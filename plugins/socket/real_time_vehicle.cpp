#include "plugins/socket/real_time_vehicle.h"

#include <algorithm>
#include <cstdio>

namespace karst::socket {

using core::kMillisecond;
using core::TimeNs;

namespace {

constexpr TimeNs kStep = 2 * kMillisecond;
constexpr TimeNs kPingPeriod = 100 * kMillisecond, kFirstPings = 10 * kMillisecond;
constexpr TimeNs kCaughtUp = 100 * kMillisecond;
constexpr TimeNs kKnownFor = 500 * kMillisecond;  // the core's state, before it steers again
constexpr std::size_t kMessagesAStep = 64;        // so that no vehicle can hold up the control

bool measured(const ToCore& m) {
  return !std::holds_alternative<Ground>(m) && !std::holds_alternative<LiftOff>(m) &&
         !std::holds_alternative<AuthorityChange>(m) && !std::holds_alternative<Lost>(m) &&
         !std::holds_alternative<core::BatteryStatus>(m);
}

std::string in_seconds(TimeNs t) {
  char text[32];
  std::snprintf(text, sizeof text, "%g s", core::seconds(t));
  return text;
}

}  // namespace

RealTimeVehicle::RealTimeVehicle(std::unique_ptr<VehicleLink> link, Wait patience,
                                 const SilenceLimits& limits)
    : link_(std::move(link)), patience_(patience), limits_(limits), steers_(link_->description().authority) {}

void RealTimeVehicle::start(core::Executive& executive, core::VehicleSink& sink) {
  executive_ = &executive;
  sink_ = &sink;
  lost_time_ = executive.lost_time();
  heard_at_ = executive.measured_now();
  executive.every("vehicle messages", executive.now() + kStep, kStep, [this] { step(); });
  try {
    link_->stream().queue(Start{});
    if (!link_->stream().flush(patience_)) throw LinkError("the vehicle takes no more messages");
  } catch (const LinkError& e) {
    lose(e.what());
  }
}

void RealTimeVehicle::step() {
  if (lost_) return;
  note_lost_time();
  if (late() > core::kCommandTimeout)
    give_away("the core was " + in_seconds(core::kCommandTimeout) + " late, so the vehicle steers itself");
  try {
    for (std::size_t read = 0; read < kMessagesAStep && !lost_;) {
      if (!next_) {
        std::optional<Received> received = link_->receive_one(Wait(0));
        if (!received) break;
        ++read;
        if (received->message) next_ = for_core(std::move(*received->message));
        if (!next_) continue;
      }
      if (const TimeNs* stamp = stamp_of(*next_); stamp && *stamp > executive_->now()) break;
      take(*std::exchange(next_, std::nullopt));
    }
    if (executive_->measured_now() >= next_ping_) ping();
    link_->stream().flush(Wait(0));
  } catch (const LinkError& e) {
    lose(e.what());
  }
  judge_silence();
}

/// The core's clock was set back. What was noted by it may lie in its future now.
void RealTimeVehicle::note_lost_time() {
  const TimeNs lost = executive_->lost_time() - lost_time_;
  if (lost == 0) return;
  lost_time_ += lost;
  const TimeNs now = executive_->measured_now();
  heard_at_ = std::min(heard_at_, now);
  next_ping_ = now;
  outstanding_.clear();
  offset_.forget();
  if (next_ && measured(*next_)) next_.reset();
  if (TimeNs* stamp = next_ ? stamp_of(*next_) : nullptr) *stamp = std::min(*stamp, now);
  sink_->on_gap();
  give_away("the core stood still for " + in_seconds(lost) + ", so the vehicle steers itself");
}

/// The message with its stamp by the core's clock, if the core is to take it. Until the offset is
/// known, so is nothing of the vehicle's clock: only what it is and does counts then, and not what it
/// measures.
std::optional<ToCore> RealTimeVehicle::for_core(ToCore message) {
  const TimeNs now = executive_->measured_now();
  if (const auto* pong = std::get_if<Pong>(&message)) {
    if (outstanding_.answered(pong->ping_sent))
      offset_.add({pong->ping_sent, now, pong->received, pong->sent});
    return std::nullopt;
  }
  TimeNs* stamp = stamp_of(message);
  if (!stamp) return message;
  if (!offset_.known() && measured(message)) return std::nullopt;
  *stamp = offset_.known() ? std::min(*stamp - offset_.offset(now), now) : executive_->now();
  return message;
}

void RealTimeVehicle::take(ToCore message) {
  if (auto* checks = std::get_if<Checks>(&message)) {
    checks_ = std::move(checks->checks);
    return;
  }
  if (const auto* change = std::get_if<AuthorityChange>(&message)) {
    steers_ = change->who;
    if (away_) return;  // told when both hear each other again
  }
  if (std::holds_alternative<Lost>(message)) lost_ = true;
  deliver(std::move(message), link_->description(), *sink_);
}

/// Behind other messages it would measure how long they take.
void RealTimeVehicle::ping() {
  if (link_->stream().backlog_bytes() > 0) return;
  const TimeNs now = executive_->measured_now();
  link_->stream().queue(Ping{now});
  outstanding_.note(now);
  next_ping_ = now + (offset_.known() ? kPingPeriod : kFirstPings);
}

/// By the machine's clock: a core that stood still hears what came meanwhile first.
void RealTimeVehicle::judge_silence() {
  if (lost_) return;
  if (link_->heard()) {
    heard_at_ = executive_->measured_now();
    const bool knows = known_since_ && executive_->now() - *known_since_ >= kKnownFor;
    if (away_ && knows && late() < kCaughtUp && offset_.known()) {
      away_ = false;
      sink_->on_authority(executive_->now(), steers_, "the vehicle and the core hear each other again");
    }
    return;
  }
  const TimeNs silence = executive_->measured_now() - heard_at_;
  if (silence >= limits_.autopilot_steers)
    give_away("no message from the vehicle for " + in_seconds(limits_.autopilot_steers));
  if (silence >= limits_.vehicle_is_lost)
    lose("no message from the vehicle for " + in_seconds(limits_.vehicle_is_lost));
}

/// The vehicle's own reaction to silence steers it now.
void RealTimeVehicle::give_away(const std::string& reason) {
  if (std::exchange(away_, true)) return;
  sink_->on_authority(executive_->now(), core::Authority::autopilot, reason);
}

/// By how much the steps of the core are behind the machine's clock.
TimeNs RealTimeVehicle::late() const { return executive_->measured_now() - executive_->now(); }

/// What cannot be sent at once is not sent at all, as the next command is newer; nor what was due long ago,
/// nor while the vehicle steers itself after a silence: it stays level by itself, and must not be lifted off
/// by commands for where it was.
void RealTimeVehicle::command(const core::Command& c) {
  if (!c.state_is_known || executive_->lost_time() != lost_time_)
    known_since_.reset();
  else if (!known_since_)
    known_since_ = executive_->now();
  if (away_) return;
  if (lost_ || executive_->lost_time() != lost_time_) return;
  if (link_->stream().backlog_bytes() > 0 || late() > kCaughtUp || !offset_.known()) return;
  core::Command sent = c;
  const TimeNs ahead = offset_.offset(executive_->measured_now());
  sent.reference.stamp += ahead;
  sent.state.stamp += ahead;
  try {
    link_->stream().queue(sent);
    link_->stream().flush(Wait(0));
  } catch (const LinkError& e) {
    lose(e.what());
  }
}

std::vector<core::VehicleCheck> RealTimeVehicle::checks() const {
  std::vector<core::VehicleCheck> all = checks_;
  all.push_back(link_->plausibility());
  const TimeNs error = offset_.known() ? offset_.error_bound(executive_->measured_now()) : 0;
  constexpr TimeNs kMostError = 5 * kMillisecond;
  all.push_back({"clock offset", "known to 5 ms", offset_.known() ? in_seconds(error) : "",
                 offset_.known() && error <= kMostError});
  return all;
}

void RealTimeVehicle::finish() {
  if (!lost_) link_->leave("the mission is over");
}

void RealTimeVehicle::lose(const std::string& reason) {
  if (lost_) return;
  lost_ = true;
  sink_->on_lost(executive_->now(), core::MissionOutcome::lost, link_->address() + ": " + reason);
}

}  // namespace karst::socket
