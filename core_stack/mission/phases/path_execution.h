// The path under way: how it is followed, and what becomes of it when the map closes it ahead or the vehicle
// has to stop.
#pragma once
#include <optional>
#include <vector>

#include "core_stack/mission/flight/route.h"
#include "core_stack/mission/flight/safety.h"
#include "core_stack/mission/flight/trusted_speeds.h"
#include "core_stack/mission/onboard/onboard.h"
#include "core_stack/mission/state/phase.h"

namespace karst::core {

/// Why what was under way is given up.
constexpr const char* kPathForbidden = "the map now forbids the path ahead";

class PathExecution {
 public:
  explicit PathExecution(Onboard& onboard)
      : options_(onboard.options), flight_(onboard.flight), recorder_(onboard.recorder) {}

  /// From where a new path may turn off, if it is followed from `at` on: where the vehicle could stop.
  RouteStart start_at_stop(TimeNs at) const;
  /// At the end of the path under way.
  RouteStart start_at_end(TimeNs at) const;

  void follow(const Route& route, TimeNs now);
  /// Follows a plan of the receding horizon, which ends in a stop before the goal.
  void steer(const Course& course, const Trajectory& plan);
  /// The path just begun leads back along the poses flown: only what the vehicle would touch stops it.
  void fly_as_come() { as_come_ = true; }
  void brake(TimeNs now);
  /// The same unless it stands.
  void stop(TimeNs now);

  /// What is left of the trajectory and has to be clear. `ground_m`: the height below which the ground is
  /// near, while the vehicle takes off.
  std::vector<Vec3> ahead(TimeNs now, std::optional<double> ground_m) const;
  const std::vector<Vec3>& narrow_places() const { return narrow_places_; }
  bool as_come() const { return as_come_; }
  /// A speed limit of its own holds for it.
  bool speed_limited() const { return speed_limited_; }

  /// The map closes the path in `after_m`. It brakes for that place, or if there is time to fly around it,
  /// asks for a detour.
  void avoid(double after_m, const PhaseMachine& phases, TimeNs now);
  /// It brakes, or stands, before a place that is closed now; or in another's way.
  bool blocked() const { return blocked_; }
  void block() { blocked_ = true; }
  void unblock() { blocked_ = false; }
  /// The path is closed farther on: a new one is due, there is no need to stop.
  bool detour_due() const { return detour_due_; }
  /// Whatever is under way leads elsewhere than to where it should.
  void ask_for_detour() { detour_due_ = !blocked_; }
  void take_no_detour() { detour_due_ = false; }

  /// What the safety supervisor has it do.
  void obey(SafetyAction action) { ordered_ = action; }
  /// The speed that it allows.
  double allowed_speed_mps() const {
    return ordered_ == SafetyAction::none ? options_.motion.max_speed_mps : slow_speed_mps(options_);
  }
  bool held() const { return ordered_ == SafetyAction::brake; }
  /// Whether another vehicle has the right of way.
  void yield(bool to_another) { yields_ = to_another; }
  bool yields() const { return yields_; }

  /// What was planned from `t` on may not be followed any more: the vehicle will not come to where it begins.
  bool braked_since(TimeNs t) const { return held() || (braked_at_ && *braked_at_ >= t); }
  /// The same, or another vehicle has the right of way.
  bool outdated(TimeNs t) const { return yields_ || braked_since(t); }
  /// It has braked itself since then.
  bool brakes_since(TimeNs t) const { return braked_at_ && *braked_at_ >= t; }

 private:
  RouteStart start(Flight::CommittedSegment committed, TimeNs at) const;

  const CoreOptions& options_;
  Flight& flight_;
  Recorder& recorder_;
  std::vector<Vec3> narrow_places_;  // of the path under way, and of what it was joined to
  bool speed_limited_ = false, as_come_ = false;
  TimeNs tight_until_ = 0;  // until then the path leads out of a place tighter than it should be
  bool blocked_ = false, detour_due_ = false, yields_ = false;
  std::optional<TimeNs> braked_at_;
  SafetyAction ordered_ = SafetyAction::none;
};

}  // namespace karst::core
