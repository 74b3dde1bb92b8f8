#include "core_stack/common/executive.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <future>
#include <mutex>
#include <new>
#include <thread>

namespace karst::core {

struct Executive::Periodic {
  std::string name;
  TimeNs period;
  std::function<void()> step;
};

struct Executive::Event {
  TimeNs time;
  std::uint64_t sequence;
  std::function<void()> step;
  const Periodic* periodic = nullptr;  // set: that is to be run, and `step` is empty
  // std::push_heap keeps the greatest in front: order by later-is-less.
  bool operator<(const Event& o) const { return time != o.time ? time > o.time : sequence > o.sequence; }
};

/// One thread that runs tasks first in, first out.
struct Executive::Worker {
  std::mutex mutex;
  std::condition_variable wake;
  std::deque<std::packaged_task<double()>> tasks;
  bool stopping = false;
  std::thread thread{[this] { loop(); }};

  ~Worker() {
    {
      const std::lock_guard lock(mutex);
      stopping = true;
    }
    wake.notify_one();
    thread.join();
  }
  void loop() {
    for (;;) {
      std::unique_lock lock(mutex);
      wake.wait(lock, [this] { return stopping || !tasks.empty(); });
      if (tasks.empty()) return;
      std::packaged_task<double()> task = std::move(tasks.front());
      tasks.pop_front();
      lock.unlock();
      task();
    }
  }
};

namespace {

double run_timed_ms(const std::function<void()>& f) {
  const auto begin = std::chrono::steady_clock::now();
  f();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

struct Executive::Job {
  std::string name;
  std::future<double> cost;
  std::function<void()> publish;
  bool ready() const { return cost.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }
};

const std::string Executive::kNoName;

Executive::Executive(int threads, Clock clock) : clock_(clock) {
  if (threads <= 1 && clock == Clock::lockstep) return;
  for (auto& w : workers_) w = std::make_unique<Worker>();
}

Executive::~Executive() = default;

int Executive::threads() const { return workers_[0] ? static_cast<int>(workers_.size()) : 1; }

void Executive::push(Event event) {
  event.time = std::max(event.time, now_);
  queue_.push_back(std::move(event));
  std::push_heap(queue_.begin(), queue_.end());
}

/// Out of memory it is a figure less, not a step less.
void Executive::note_cost(const std::string& name, double milliseconds) {
  try {
    costs_[name].milliseconds.push_back(static_cast<float>(milliseconds));
  } catch (const std::bad_alloc&) {
  }
}

void Executive::at(TimeNs time, std::function<void()> step) {
  push({time, next_sequence_++, std::move(step)});
}

void Executive::every(std::string name, TimeNs first, TimeNs period, std::function<void()> step) {
  periodic_.push_back(std::make_unique<Periodic>(Periodic{std::move(name), period, std::move(step)}));
  push({first, next_sequence_++, {}, periodic_.back().get()});
}

void Executive::run_periodic(const Periodic& periodic, TimeNs due) {
  if (clock_ == Clock::real_time && wall() - due >= periodic.period) ++costs_[periodic.name].overruns;
  note_cost(periodic.name, run_timed_ms(periodic.step));
}

void Executive::run(const Event& event) {
  ++events_;
  running_ = event.periodic ? &event.periodic->name : &kNoName;
  if (!event.periodic) return event.step();
  // It is due again whatever becomes of it now. It keeps its sequence number: a new one each time would let a
  // slow step overtake a faster one registered earlier. The queue has room: this event was just taken out.
  push({event.time + event.periodic->period, event.sequence, {}, event.periodic});
  run_periodic(*event.periodic, event.time);
}

int Executive::under_way(const std::string& name) const {
  const auto found = under_way_.find(name);
  return found == under_way_.end() ? 0 : found->second;
}

void Executive::job(std::string name, Lane lane, TimeNs budget, std::function<void()> work,
                    std::function<void()> publish) {
  std::packaged_task<double()> task([work = std::move(work)] { return run_timed_ms(work); });
  auto job = std::make_shared<Job>(Job{std::move(name), task.get_future(), std::move(publish)});
  if (const auto& worker = workers_[static_cast<std::size_t>(lane)]) {
    {
      const std::lock_guard lock(worker->mutex);
      worker->tasks.push_back(std::move(task));
    }
    worker->wake.notify_one();
  } else {
    task();
  }
  int& under_way = under_way_[job->name];  // may need memory: before anything is in the queue
  Executive::at(now_ + budget, [this, job] {
    if (clock_ == Clock::real_time && !job->ready()) {
      ++costs_[job->name].overruns;
      late_.push_back(job);
    } else {
      finish(job);
    }
  });
  ++under_way;
}

void Executive::finish(const std::shared_ptr<Job>& job) {
  const auto counted = under_way_.find(job->name);
  --counted->second;
  running_ = &counted->first;
  note_cost(job->name, job->cost.get());  // waits, rethrows
  job->publish();
}

/// Publishes the first late job that is ready now, if any.
bool Executive::finish_late_job() {
  const auto ready = std::find_if(late_.begin(), late_.end(), [](const auto& job) { return job->ready(); });
  if (ready == late_.end()) return false;
  const std::shared_ptr<Job> job = *ready;
  late_.erase(ready);
  now_ =
      std::max(now_, std::min(wall(), queue_.front().time));  // never past what is due: it keeps its own time
  finish(job);
  return true;
}

int Executive::overruns() const {
  int n = 0;
  for (const auto& [name, cost] : costs_) n += cost.overruns;
  return n;
}

TimeNs Executive::wall() const {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - begin_)
      .count();
}

/// Not longer than a moment while a job is late: it may be ready any time.
void Executive::wait_until(TimeNs time) const {
  constexpr TimeNs kMoment = kMillisecond / 2;
  const TimeNs until = late_.empty() ? time : std::min(time, wall() + kMoment);
  std::this_thread::sleep_until(begin_ + std::chrono::nanoseconds(until));
}

void Executive::run_until(TimeNs limit, const std::function<bool()>& done) {
  const bool real_time = clock_ == Clock::real_time;
  if (real_time) begin_ = std::chrono::steady_clock::now() - std::chrono::nanoseconds(now_);
  while (!queue_.empty() && queue_.front().time <= limit) {
    if (real_time && finish_late_job()) {
      if (done()) return;
      continue;
    }
    if (real_time && wall() < queue_.front().time) {
      wait_until(queue_.front().time);
      continue;
    }
    std::pop_heap(queue_.begin(), queue_.end());
    Event event = std::move(queue_.back());
    queue_.pop_back();
    now_ = std::max(now_, event.time);
    run(event);
    running_ = &kNoName;
    if (done()) return;
  }
  now_ = std::max(now_, limit);
}

void Executive::drain() {
  const bool threaded = workers_[0] != nullptr;
  for (auto& w : workers_) w.reset();  // all of them, before any is made anew: that may fail
  if (threaded)
    for (auto& w : workers_) w = std::make_unique<Worker>();
  late_.clear();
}

}  // namespace karst::core
