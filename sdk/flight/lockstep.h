// The loop that flies one vehicle, or several in one world, each with its own core stack.
//
// Every tenth of a second all vehicles have come to the same time; then the hooks let them meet and hear each
// other. In between each runs by itself, so it does not matter which thread runs it when: the same mission
// gives the same bytes with any number of threads. A single vehicle is the case of one, without hooks.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/mission/mission_control.h"

namespace karst::flight {

/// What one vehicle flies with. All of it outlives the flight.
struct Seat {
  core::Vehicle* vehicle = nullptr;
  core::PolicyPort* policy = nullptr;
  core::Recorder* recorder = nullptr;
  core::Teamwork* teamwork = nullptr;  // null: it is no member of a team
  core::TimeNs starts_at = 0;          // when it is switched on, by the flight's clock
};

/// How far a vehicle has come.
struct SeatState {
  core::MissionStatus status;
  core::Phase phase = core::Phase::standby;  // after the last step
  core::TimeNs explored_for = 0;
  std::string homing_reason;  // why it explores no more
  bool flying = false;        // it has started, and has not been put away yet
  bool stopped = false;       // it was told to land, or not to start
  std::optional<core::MissionResult> ended;
  std::optional<core::TimeNs> ended_at;
};

class Lockstep;

/// What happens between two steps. Vehicles are numbered from 0; times are the flight's. An exception makes
/// all vehicles land.
class StepHooks {
 public:
  virtual ~StepHooks() = default;
  virtual void on_start(std::size_t vehicle, core::TimeNs now) = 0;
  /// All vehicles have come to `now`.
  virtual void exchange(Lockstep& flight, core::TimeNs now) = 0;
  /// A vehicle's phase has changed; its state tells to which.
  virtual void on_phase(const Lockstep& flight, std::size_t vehicle, core::TimeNs now) = 0;
  virtual void inject_faults(const Lockstep& flight, core::TimeNs now) = 0;
};

/// Called every second of the flight with every vehicle's status; returns false to have them all land.
using FlightWatch = std::function<bool(core::TimeNs now, const std::vector<core::MissionStatus>&)>;

struct LockstepOptions {
  /// Of one vehicle: for its jobs. Of several: for the vehicles, each of which does its jobs itself.
  int threads = 1;
  core::Clock clock = core::Clock::lockstep;  // in real time one vehicle flies only
  core::TimeNs linger = 0;                    // the hooks go on for so long after the last landing
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
  /// Where a vehicle's steps and jobs run, for timing.json.
  const core::Executive& executive(std::size_t vehicle) const;
  /// At once, or it does not start.
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
