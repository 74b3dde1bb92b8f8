#include "core_stack/common/executive.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <future>
#include <mutex>
#include <new>
#include <thread>
#include <utility>

#include "core_stack/common/inheriting_mutex.h"

namespace karst::core {

struct Executive::Periodic {
  std::string name;
  TimeNs period;
  std::function<void()> step;
  Punctuality* punctuality = nullptr;  // in real time
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
  InheritingMutex mutex;
  Condition wake;
  std::deque<std::packaged_task<TimeNs()>> tasks;
  bool stopping = false;
  std::thread thread;

  explicit Worker(std::function<void()> on_thread)
      : thread([this, on_thread = std::move(on_thread)] {
          if (on_thread) on_thread();
          loop();
        }) {}
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
      wake.wait(mutex, [this] { return stopping || !tasks.empty(); });
      if (tasks.empty()) return;
      std::packaged_task<TimeNs()> task = std::move(tasks.front());
      tasks.pop_front();
      lock.unlock();
      task();
    }
  }
};

namespace {

TimeNs run_timed(const std::function<void()>& f) {
  const TimeNs begin = machine_clock().now();
  f();
  return machine_clock().now() - begin;
}

}  // namespace

struct Executive::Job {
  std::string name;
  Lane lane;
  TimeNs due;
  std::future<TimeNs> cost;
  std::function<void()> publish;
  bool ready() const { return cost.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }
};

const std::string Executive::kNoName;

Executive::Executive(int threads, Clock clock, RealTimeSetup setup)
    : clock_(clock), setup_(std::move(setup)) {
  if (threads > 1 || clock == Clock::real_time) start_workers();
}

void Executive::start_workers() {
  for (std::size_t lane = 0; lane < workers_.size(); ++lane) {
    std::function<void()> on_thread;
    if (clock_ == Clock::real_time && setup_.on_lane_thread)
      on_thread = [set_up = setup_.on_lane_thread, lane] { set_up(static_cast<Lane>(lane)); };
    workers_[lane] = std::make_unique<Worker>(std::move(on_thread));
  }
}

Executive::~Executive() = default;

int Executive::threads() const { return workers_[0] ? static_cast<int>(workers_.size()) : 1; }

void Executive::push(Event event) {
  event.time = std::max(event.time, now_);
  queue_.push_back(std::move(event));
  std::push_heap(queue_.begin(), queue_.end());
}

/// Out of memory it is a figure less, not a step less.
void Executive::note_cost(const std::string& name, TimeNs duration) {
  try {
    costs_[name].duration.add(duration);
  } catch (const std::bad_alloc&) {
  }
}

void Executive::at(TimeNs time, std::function<void()> step) {
  push({time, next_sequence_++, std::move(step)});
}

void Executive::every(std::string name, TimeNs first, TimeNs period, std::function<void()> step) {
  Punctuality* punctuality = clock_ == Clock::real_time ? &punctuality_[name] : nullptr;
  periodic_.push_back(
      std::make_unique<Periodic>(Periodic{std::move(name), period, std::move(step), punctuality}));
  push({first, next_sequence_++, {}, periodic_.back().get()});
}

void Executive::run_periodic(const Periodic& periodic, TimeNs due) {
  if (!periodic.punctuality) return note_cost(periodic.name, run_timed(periodic.step));
  const TimeNs lateness = wall() - due;
  periodic.punctuality->lateness.add(lateness);
  if (lateness >= periodic.period) ++costs_[periodic.name].overruns;
  note_cost(periodic.name, run_timed(periodic.step));
  if (wall() - due >= periodic.period) ++periodic.punctuality->missed_deadlines;
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
  std::packaged_task<TimeNs()> task([work = std::move(work)] { return run_timed(work); });
  auto job =
      std::make_shared<Job>(Job{std::move(name), lane, now_ + budget, task.get_future(), std::move(publish)});
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
  note_lateness(*job);
  finish(job);
  return true;
}

void Executive::note_lateness(const Job& job) {
  TimeNs& greatest = lateness_[static_cast<std::size_t>(job.lane)];
  greatest = std::max(greatest, now_ - job.due);
}

TimeNs Executive::take_lateness(Lane lane) {
  for (const auto& job : late_) note_lateness(*job);
  return std::exchange(lateness_[static_cast<std::size_t>(lane)], 0);
}

int Executive::overruns() const {
  int n = 0;
  for (const auto& [name, cost] : costs_) n += cost.overruns;
  return n;
}

TimeNs Executive::wall() const { return setup_.clock->now() - begin_; }

/// Not longer than a moment while a job is late: it may be ready any time.
void Executive::wait_until(TimeNs time) const {
  constexpr TimeNs kMoment = kMillisecond / 2;
  setup_.clock->sleep_until(begin_ + (late_.empty() ? time : std::min(time, wall() + kMoment)));
}

/// A loop that is far behind what is due never catches up, or floods the vehicle with what is out of date.
void Executive::forgive(TimeNs due) {
  constexpr TimeNs kMaxBehind = kSecond;
  const TimeNs behind = wall() - due;
  if (behind <= kMaxBehind) return;
  begin_ += behind;
  lost_time_ += behind;
}

void Executive::run_until(TimeNs limit, const std::function<bool()>& done) {
  const bool real_time = clock_ == Clock::real_time;
  // Once only: after an exception the time that the failing step took is lateness like any other.
  if (real_time && begin_ == 0) begin_ = setup_.clock->now() - now_;
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
    if (real_time) forgive(event.time);
    if (done()) return;
  }
  now_ = std::max(now_, limit);
}

void Executive::drain() {
  const bool threaded = workers_[0] != nullptr;
  for (auto& w : workers_) w.reset();  // all of them, before any is made anew: that may fail
  if (threaded) start_workers();
  late_.clear();
}

}  // namespace karst::core
