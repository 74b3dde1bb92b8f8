#include "plugins/socket/real_time_vehicle.h"

#include <algorithm>
#include <cstdio>

namespace karst::socket {

using core::kMillisecond;
using core::TimeNs;

namespace {

constexpr TimeNs kStep = 2 * kMillisecond;
constexpr TimeNs kPingPeriod = 100 * kMillisecond, kFirstPings = 10 * kMillisecond;
constexpr int kQuickPings = 16;  // at the start, until the offset is known well
constexpr TimeNs kCaughtUp = 100 * kMillisecond;
constexpr std::size_t kMessagesAStep = 64;  // so that no vehicle can hold up the control

/// Where a message has its stamp; null for those without.
struct StampOf {
  TimeNs* operator()(auto&) const { return nullptr; }
  TimeNs* operator()(Depth& m) const { return &m.image.stamp; }
  TimeNs* operator()(Objects& m) const { return &m.look.stamp; }
  template <class M>
  requires requires(M& m) { m.stamp; }
  TimeNs* operator()(M& m) const { return &m.stamp; }
};

TimeNs* stamp_of(ToCore& message) { return std::visit(StampOf{}, message); }

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
  clock_.note_step(executive.now());
  heard_at_ = clock_.now();
  executive.every("vehicle messages", executive.now() + kStep, kStep, [this] { step(); });
  try {
    link_->stream().queue(Start{});
    if (!link_->stream().flush(patience_)) throw LinkError("the vehicle takes no more messages");
  } catch (const LinkError& e) {
    lose(e.what());
  }
}

void RealTimeVehicle::step() {
  clock_.note_step(executive_->now());
  if (lost_) return;
  if (late() > core::kCommandTimeout)
    give_away("the core was " + in_seconds(core::kCommandTimeout) +
              " late, so the vehicle comes down by itself");
  try {
    for (std::size_t i = 0; i < kMessagesAStep && !lost_; ++i) {
      if (!next_ && !(next_ = receive())) break;
      if (const TimeNs* stamp = stamp_of(*next_); stamp && *stamp > executive_->now()) break;
      take(*std::exchange(next_, std::nullopt));
    }
    if (clock_.now() >= next_ping_) ping();
    link_->stream().flush(Wait(0));
  } catch (const LinkError& e) {
    lose(e.what());
  }
  judge_silence();
}

/// The next message for the core, with its stamp by the core's clock. Before the first round trip nothing is
/// known of the vehicle's clock: only what it is and does counts then, and not what it measures.
std::optional<ToCore> RealTimeVehicle::receive() {
  while (std::optional<ToCore> message = link_->receive(Wait(0))) {
    if (const auto* pong = std::get_if<Pong>(&*message)) {
      offset_.add({pong->ping_sent, clock_.now(), pong->received, pong->sent});
      continue;
    }
    TimeNs* stamp = stamp_of(*message);
    if (!stamp) return message;
    if (!offset_.known() && measured(*message)) continue;
    const TimeNs now = clock_.now();
    *stamp = offset_.known() ? std::min(*stamp - offset_.offset(now), now) : executive_->now();
    return message;
  }
  return std::nullopt;
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

void RealTimeVehicle::ping() {
  const TimeNs now = clock_.now();
  link_->stream().queue(Ping{now});
  next_ping_ = now + (++pings_ < kQuickPings ? kFirstPings : kPingPeriod);
}

/// By the machine's clock: a core that stood still hears what came meanwhile first.
void RealTimeVehicle::judge_silence() {
  if (lost_) return;
  if (link_->heard()) {
    heard_at_ = clock_.now();
    if (away_ && late() < kCaughtUp) {
      away_ = false;
      sink_->on_authority(executive_->now(), steers_, "the vehicle and the core hear each other again");
    }
    return;
  }
  const TimeNs silence = clock_.now() - heard_at_;
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
TimeNs RealTimeVehicle::late() const { return clock_.now() - executive_->now(); }

/// What cannot be sent at once is not sent at all, as the next command is newer; nor what was due long ago: a
/// vehicle that came down by itself must not be lifted off by commands for where it was.
void RealTimeVehicle::command(const core::Command& c) {
  if (lost_ || link_->stream().backlog_bytes() > 0 || late() > kCaughtUp) return;
  core::Command sent = c;
  if (offset_.known()) {
    const TimeNs ahead = offset_.offset(clock_.now());
    sent.reference.stamp += ahead;
    sent.state.stamp += ahead;
  }
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
  const TimeNs error = offset_.error_bound(clock_.now());
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
