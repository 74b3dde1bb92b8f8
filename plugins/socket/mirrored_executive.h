// The executive of a vehicle that flies in lockstep with a client: it tells the client what is scheduled, in
// the order of the vehicle's calls, and runs one slot at a time, when the client asks for it.
#pragma once
#include <optional>

#include "plugins/socket/stream.h"

namespace karst::socket {

class MirroredExecutive final : public core::Executive {
 public:
  MirroredExecutive(int threads, Stream& client) : Executive(threads), client_(client) {}

  void every(std::string name, core::TimeNs first, core::TimeNs period, std::function<void()> step) override {
    const std::uint32_t slot = announce(first, period);
    Executive::every(std::move(name), first, period, noted(slot, std::move(step)));
  }
  void at(core::TimeNs time, std::function<void()> step) override {
    const std::uint32_t slot = announce(time, 0);
    Executive::at(time, noted(slot, std::move(step)));
  }
  void job(std::string name, core::Lane lane, core::TimeNs budget, std::function<void()> work,
           std::function<void()> publish) override {
    const std::uint32_t slot = announce(now() + budget, 0);
    Executive::job(std::move(name), lane, budget, std::move(work), noted(slot, std::move(publish)));
  }

  /// Runs what is due next. False if that is not `slot`, or not at `time`: then the client's clock is not
  /// ours.
  bool run(std::uint32_t slot, core::TimeNs time) {
    ran_.reset();
    run_until(time, [] { return true; });
    return ran_ == slot && now() == time;
  }
  /// Nothing is told any more: the client is gone.
  void mute() { muted_ = true; }

 private:
  std::uint32_t announce(core::TimeNs due, core::TimeNs period) {
    if (!muted_) client_.queue(Schedule{next_, std::max(due, now()), period});
    return next_++;
  }
  std::function<void()> noted(std::uint32_t slot, std::function<void()> step) {
    return [this, slot, step = std::move(step)] {
      ran_ = slot;
      step();
    };
  }

  Stream& client_;
  std::uint32_t next_ = 0;
  std::optional<std::uint32_t> ran_;
  bool muted_ = false;
};

}  // namespace karst::socket
