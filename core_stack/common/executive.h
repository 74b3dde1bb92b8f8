// The executive runs every module from time-stamped events.
//
// Periodic steps run on the loop's thread at exact times. Longer work is a *job*: it starts at time t on
// a worker lane and its result is published on the loop's thread at t + budget. In lockstep the clock
// waits for a job that is late, so every result appears at the same simulated time whatever the
// machine's load or number of threads. In real time the clock is the machine's: what is due runs when it is
// due or as soon after as it can, a late job's result appears when it is ready, and the delay is counted.
// Jobs of one lane run one after another in the order submitted, so whatever a lane owns (the map, the sensor
// models) needs no lock.
//
// An exception in a step or a job leaves run_until(), which may be called again: periodic steps come all the
// same, and no memory is allocated to repeat them.
#pragma once
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core_stack/common/duration_histogram.h"
#include "core_stack/common/enum_names.h"
#include "core_stack/common/time.h"
#include "core_stack/common/wall_clock.h"

namespace karst::core {

enum class Lane { sensing, localization, map, pictures, registration };
constexpr std::size_t kLanes = 5;
constexpr auto names_of(Lane) {
  using enum Lane;
  return std::to_array<Named<Lane>>({{sensing, "sensing"},
                                     {localization, "localization"},
                                     {map, "map"},
                                     {pictures, "pictures"},
                                     {registration, "registration"}});
}

/// Wall-clock cost of one named step or job, for timing.json only: nothing decides by it.
struct Cost {
  DurationHistogram duration;
  int overruns = 0;  // in real time: jobs not ready within their budget, steps a whole period late
};

/// How well a periodic step keeps its times, in real time.
struct Punctuality {
  DurationHistogram lateness;          // from when a step was due to when it began
  std::uint64_t missed_deadlines = 0;  // steps that ended when the next one was due already, or later
};

enum class Clock { lockstep, real_time };

/// What a flight in real time runs on.
struct RealTimeSetup {
  const WallClock* clock = &machine_clock();
  std::function<void(Lane)> on_lane_thread = {};  // called once on each lane's thread, before its first job
};

class Executive {
 public:
  /// `threads` <= 1 runs jobs on the loop's thread at the moment they are submitted; more give each lane a
  /// thread, and no more than that.
  /// In real time there is always a thread a lane. `setup` has an effect only there.
  explicit Executive(int threads, Clock clock = Clock::lockstep, RealTimeSetup setup = {});
  virtual ~Executive();  // virtual, as what registers work: a test has single steps and jobs fail
  Executive(const Executive&) = delete;
  Executive& operator=(const Executive&) = delete;

  TimeNs now() const { return now_; }
  /// In real time, the machine's time on the same clock: at or after now(), which is when the step that runs
  /// was due. What comes from outside is stamped by it. In lockstep, now().
  TimeNs measured_now() const { return begin_ != 0 ? std::max(now_, wall()) : now_; }
  /// Threads that do jobs: one a lane, or 1, the loop's own.
  int threads() const;

  /// Runs `step` at `first`, `first + period`, ... Whatever is due at one time runs in the order of
  /// registration, a periodic step by its first.
  virtual void every(std::string name, TimeNs first, TimeNs period, std::function<void()> step);
  /// Runs `step` once at `time` (not before now).
  virtual void at(TimeNs time, std::function<void()> step);
  /// Runs `work` on `lane`, then `publish` on the loop's thread at now + budget. An exception in `work`
  /// is rethrown from run_until() at that time.
  virtual void job(std::string name, Lane lane, TimeNs budget, std::function<void()> work,
                   std::function<void()> publish);
  /// Jobs of that name which are neither published nor failed.
  int under_way(const std::string& name) const;

  /// Advances the clock event by event until `done()` holds after an event or `limit` is passed.
  void run_until(TimeNs limit, const std::function<bool()>& done);
  /// Waits for jobs still running; their results are not published.
  void drain();

  /// Of steps and results so far. May be read from any thread: where it stays as it is, the loop hangs.
  std::uint64_t events() const { return events_; }
  /// Name of the step or job that the loop runs, publishes or waits for; "" for one without a name. From any
  /// thread.
  std::string running() const { return running_.load()->c_str(); }

  /// In all; 0 in lockstep.
  int overruns() const;
  const std::map<std::string, Cost>& costs() const { return costs_; }
  /// Of each periodic step; empty in lockstep.
  const std::map<std::string, Punctuality>& punctuality() const { return punctuality_; }
  /// The greatest time by which a job of the lane exceeded its budget since this was last asked, including
  /// those that still run or wait. 0 in lockstep, where nothing is late.
  TimeNs take_lateness(Lane lane);
  /// A loop that is a second behind sets its clock back to what is due. The time lost in this way so far.
  TimeNs lost_time() const { return lost_time_; }

 private:
  struct Event;
  struct Worker;
  struct Job;
  struct Periodic;
  void push(Event event);
  void run(const Event& event);
  void run_periodic(const Periodic& step, TimeNs due);
  void note_cost(const std::string& name, TimeNs duration);
  void finish(const std::shared_ptr<Job>& job);
  bool finish_late_job();
  TimeNs wall() const;
  void wait_until(TimeNs time) const;

  void start_workers();
  void forgive(TimeNs due);
  void note_lateness(const Job& job);

  Clock clock_;
  RealTimeSetup setup_;
  TimeNs begin_ = 0;                        // of the run by the machine's clock, in real time
  std::vector<std::shared_ptr<Job>> late_;  // in real time: beyond their budget
  std::array<TimeNs, kLanes> lateness_{};   // by lane, since last asked
  TimeNs lost_time_ = 0;
  TimeNs now_ = 0;
  std::uint64_t next_sequence_ = 0;
  std::vector<Event> queue_;                             // heap on (time, sequence)
  std::array<std::unique_ptr<Worker>, kLanes> workers_;  // by lane; all or none
  std::vector<std::unique_ptr<Periodic>> periodic_;
  std::map<std::string, int> under_way_;  // an entry for every job's name that ever was
  static const std::string kNoName;
  std::atomic<std::uint64_t> events_ = 0;
  std::atomic<const std::string*> running_ = &kNoName;  // to what is never taken away
  std::map<std::string, Cost> costs_;
  std::map<std::string, Punctuality> punctuality_;
};

}  // namespace karst::core
