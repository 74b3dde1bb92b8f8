#include "sdk/host/in_process/decision_thread.h"

#include <pthread.h>

#include <chrono>
#include <ctime>
#include <utility>

namespace karst::host {
namespace {

constexpr auto kBetweenLooks = std::chrono::milliseconds(20);

}  // namespace

DecisionThread::DecisionThread()
    : channel_(std::make_shared<Channel>()), thread_([channel = channel_] { serve(channel); }) {}

DecisionThread::~DecisionThread() {
  {
    const std::lock_guard lock(channel_->mutex);
    channel_->stop = true;
  }
  channel_->changed.notify_all();
  if (hangs_)
    thread_.detach();
  else
    thread_.join();
}

void DecisionThread::serve(std::shared_ptr<Channel> channel) {
  std::unique_lock lock(channel->mutex);
  for (;;) {
    channel->changed.wait(lock, [&] { return channel->stop || channel->task; });
    if (!channel->task) return;
    const std::function<void()> task = channel->task;
    lock.unlock();
    task();
    lock.lock();
    channel->task = nullptr;
    channel->changed.notify_all();
    if (channel->stop) return;
  }
}

double DecisionThread::cpu_s() {
  clockid_t clock{};
  timespec t{};
  if (pthread_getcpuclockid(thread_.native_handle(), &clock) != 0 || clock_gettime(clock, &t) != 0) return 0;
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::string DecisionThread::run(std::function<void()> task, const CallLimits& limits) {
  if (hangs_) return "hangs in an earlier call";
  const auto begin = std::chrono::steady_clock::now();
  const double cpu_before_s = cpu_s();
  std::unique_lock lock(channel_->mutex);
  channel_->task = std::move(task);
  channel_->changed.notify_all();
  while (!channel_->changed.wait_for(lock, kBetweenLooks, [&] { return !channel_->task; })) {
    const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - begin;
    const std::string which = passed(limits, waited.count(), cpu_s() - cpu_before_s);
    hangs_ = !which.empty();
    if (hangs_) return which;
  }
  return "";
}

}  // namespace karst::host
