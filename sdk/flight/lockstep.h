// The loop that flies one vehicle, or several in one world, each with its own core stack.
//
// Every tenth of a second all vehicles have reached the same time; then the hooks exchange their positions
// and radio messages. In between each vehicle runs independently, so it does not matter which thread runs it
// when: the same mission gives the same bytes with any number of threads. A single vehicle needs no hooks.
#pragma once
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/common/stall_watch.h"
#include "core_stack/mission/mission_control.h"

namespace karst::flight {

/// The objects that one vehicle flies with. They outlive the flight.
struct Seat {
  core::Vehicle* vehicle = nullptr;
  core::PolicyPort* policy = nullptr;
  core::Recorder* recorder = nullptr;
  core::Teamwork* teamwork = nullptr;  // null: not a member of a team
  core::TimeNs starts_at = 0;          // time at which it is switched on, by the flight's clock
};

/// The progress of a vehicle.
struct SeatState {
  core::MissionStatus status;
  core::Phase phase = core::Phase::standby;  // after the last step
  core::TimeNs explored_for = 0;
  std::string homing_reason;  // why it has stopped exploring
  bool flying = false;        // it has started, and is not done yet
  bool stopped = false;       // it was ordered to land, or not to start
  std::optional<core::MissionResult> ended;
  std::optional<core::TimeNs> ended_at;
  std::vector<std::pair<core::Relief, int>> degraded;  // after its end: what was left out, and how often
};

class Lockstep;

/// Callbacks between two steps. Vehicles are numbered from 0; times are by the flight's clock. An exception
/// makes all vehicles land.
class StepHooks {
 public:
  virtual ~StepHooks() = default;
  virtual void on_start(std::size_t vehicle, core::TimeNs now) = 0;
  /// Called when all vehicles have reached `now`.
  virtual void exchange(Lockstep& flight, core::TimeNs now) = 0;
  /// Called when a vehicle's phase has changed; its state has the new phase.
  virtual void on_phase(const Lockstep& flight, std::size_t vehicle, core::TimeNs now) = 0;
  virtual void inject_faults(const Lockstep& flight, core::TimeNs now) = 0;
};

/// Called every second of the flight with every vehicle's status; returns false to have them all land.
using FlightWatch = std::function<bool(core::TimeNs now, const std::vector<core::MissionStatus>&)>;

/// For a flight in real time.
struct RealTime {
  core::RealTimeSetup setup;
  std::function<void()> on_loop_thread, on_watch_thread;  // called once on these, before the flight
  std::function<void()> on_landed;  // called on the loop's thread when it stands still for good: the vehicle
                                    // has ended its flight, and the map is not written yet
  std::chrono::milliseconds hang_limit{2000}, end_limit{600'000};  // in flight; while the record is completed
  core::StallWatch::Report on_hang;  // if the loop hangs for so long; empty: nobody watches
};

struct LockstepOptions {
  /// Threads for the jobs of a single vehicle, or for the vehicles of a team, which run their own jobs.
  int threads = 1;
  core::Clock clock = core::Clock::lockstep;  // in real time only one vehicle can fly
  core::TimeNs linger = 0;                    // time for which the hooks run on after the last landing
  RealTime real_time = {};
};

class Lockstep {
 public:
  Lockstep(const core::CoreOptions& options, const LockstepOptions& how, const std::vector<Seat>& seats,
           StepHooks* hooks = nullptr);
  ~Lockstep();

  /// Flies all missions to their ends; returns when the flight is over, by its clock.
  core::TimeNs run(const FlightWatch& watch);

  std::size_t size() const { return vehicles_.size(); }
  const SeatState& state(std::size_t vehicle) const;
  core::TimeNs starts_at(std::size_t vehicle) const;
  /// The executive of a vehicle's steps and jobs, for timing.json.
  const core::Executive& executive(std::size_t vehicle) const;
  /// Lands a vehicle at once, or prevents its start.
  void land(std::size_t vehicle, const char* reason);

 private:
  struct Vehicle;
  void run_in_real_time(const FlightWatch& watch);
  void run_in_steps(const FlightWatch& watch);
  void start(std::size_t i, const FlightWatch& watch);
  void land_all(const char* reason);
  void fly_all_to(core::TimeNs time);
  void note_phases();
  bool ask(const FlightWatch& watch, core::TimeNs now);
  bool over() const;

  core::CoreOptions options_;
  LockstepOptions how_;
  StepHooks* hooks_;
  std::vector<std::unique_ptr<Vehicle>> vehicles_;
  core::TimeNs now_ = 0;
};

}  // namespace karst::flight
