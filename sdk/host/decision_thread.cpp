#include "sdk/host/decision_thread.h"

#include <chrono>
#include <utility>

namespace karst::host {

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

bool DecisionThread::run(std::function<void()> task, double limit_s) {
  if (hangs_) return false;
  std::unique_lock lock(channel_->mutex);
  channel_->task = std::move(task);
  channel_->changed.notify_all();
  hangs_ = !channel_->changed.wait_for(lock, std::chrono::duration<double>(limit_s),
                                       [&] { return !channel_->task; });
  return !hangs_;
}

}  // namespace karst::host
