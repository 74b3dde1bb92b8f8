#include "plugins/socket/lockstep_vehicle.h"

#include <exception>

namespace karst::socket {
namespace {

constexpr core::TimeNs kMinPeriod = core::kMillisecond;
constexpr int kMaxRunsAtOnce = 1000;  // at one time: a vehicle that schedules more never lets time pass

}  // namespace

LockstepVehicle::LockstepVehicle(std::unique_ptr<VehicleLink> link, Wait patience)
    : link_(std::move(link)), patience_(patience) {}

void LockstepVehicle::start(core::Executive& executive, core::VehicleSink& sink) {
  executive_ = &executive;
  sink_ = &sink;
  ask(Start{});
}

/// Goes with the next request, before it.
void LockstepVehicle::command(const core::Command& c) {
  if (!lost_) link_->stream().queue(c);
}

std::vector<core::VehicleCheck> LockstepVehicle::checks() const {
  std::vector<core::VehicleCheck> all = checks_;
  all.push_back(link_->plausibility());
  return all;
}

void LockstepVehicle::finish() {
  if (!lost_) link_->leave("the mission is over");
}

template <class Request>
void LockstepVehicle::ask(const Request& request) {
  if (lost_) return;
  try {
    link_->stream().queue(request);
    take_answer();
  } catch (const LinkError& e) {
    lose(e.what());
  }
}

/// A failure of the core must not leave half an answer: it is thrown when the answer is complete.
void LockstepVehicle::take_answer() {
  std::exception_ptr failure;
  for (;;) {
    if (!link_->stream().flush(patience_)) throw LinkError("the vehicle takes no more messages");
    std::optional<ToCore> message = link_->receive(patience_);
    if (!message)
      throw LinkError("the vehicle has not answered for " + std::to_string(patience_.count() / 1000) + " s");
    if (std::holds_alternative<Done>(*message)) break;
    try {
      take(std::move(*message));
    } catch (const LinkError&) {
      throw;
    } catch (...) {
      if (!failure) failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
}

void LockstepVehicle::take(ToCore message) {
  if (const auto* slot = std::get_if<Schedule>(&message)) return mirror(*slot);
  if (auto* checks = std::get_if<Checks>(&message)) {
    checks_ = std::move(checks->checks);
    return;
  }
  if (std::holds_alternative<Pause>(message)) return link_->stream().queue(Resume{});
  deliver(std::move(message), link_->description(), *sink_);
}

void LockstepVehicle::mirror(const Schedule& s) {
  const bool can_be = is_plausible_time(s.due) && is_plausible_time(s.period);
  if (!can_be || s.due < executive_->now() || (s.period != 0 && s.period < kMinPeriod))
    throw LinkError("the vehicle schedules what cannot be: a time that is past, or a period below 1 ms");
  if (s.period == 0)
    executive_->at(s.due, [this, slot = s.slot] { run_slot(slot); });
  else
    executive_->every("vehicle", s.due, s.period, [this, slot = s.slot] { run_slot(slot); });
}

void LockstepVehicle::run_slot(std::uint32_t slot) {
  const core::TimeNs now = executive_->now();
  runs_at_once_ = now == last_run_ ? runs_at_once_ + 1 : 0;
  last_run_ = now;
  if (runs_at_once_ > kMaxRunsAtOnce) lose("the vehicle schedules without end, so that no time passes");
  ask(Run{slot, now});
}

void LockstepVehicle::lose(const std::string& reason) {
  if (lost_) return;
  lost_ = true;
  sink_->on_lost(executive_->now(), core::MissionOutcome::lost, link_->address() + ": " + reason);
}

}  // namespace karst::socket
