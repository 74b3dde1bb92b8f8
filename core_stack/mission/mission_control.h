// Mission control, the top loop: it turns sensor messages into a map, the policy's goals into paths, and
// paths into commands. Whatever happens, the vehicle returns home and lands.
//
//   standby -> takeoff -> (look) -> explore -> home -> land -> done       (state/phase.cpp)
//   and manual, while the pilot or the autopilot steers
//
// Each part owns its state: SensorPipeline (localization, mapping), EarlierMapSearch, Exploration and
// GoalTracker, PathExecution, Steering, ReturnHome and RelayLanding, TeamSharing and RightOfWay,
// ObjectSearch. This class wires them.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "core_stack/mission/flight/step_watch.h"
#include "core_stack/mission/object_search.h"
#include "core_stack/mission/phases/earlier_map_search.h"
#include "core_stack/mission/phases/exploration.h"
#include "core_stack/mission/phases/return_home.h"
#include "core_stack/mission/phases/steering.h"
#include "core_stack/mission/phases/take_off.h"
#include "core_stack/mission/sensor_pipeline.h"
#include "core_stack/mission/team/right_of_way.h"
#include "core_stack/mission/team/team_sharing.h"

namespace karst::core {

/// Status for an operator.
struct MissionStatus {
  TimeNs time = 0;
  Phase phase = Phase::standby;
  std::optional<BatteryStatus> battery;  // nothing before its first message
  double explored_m3 = 0, speed_mps = 0;
  std::string goal;
  std::string waits_for;  // why the core does not fly: "waits: not armed"; "" if it does
};

/// Called every second of flight; returns false to make the vehicle land where it is.
using Watch = std::function<bool(const MissionStatus&)>;

struct MissionResult {
  MissionOutcome outcome = MissionOutcome::aborted;
  std::string reason;
  bool stands = false;              // undamaged, on the ground
  std::string record_problem = {};  // why the run directory is incomplete; empty if it is complete
};

class MissionControl final : public VehicleSink {
 public:
  MissionControl(const CoreOptions& options, Vehicle& vehicle, Executive& executive, PolicyPort& policy,
                 Recorder& recorder, Teamwork* team = nullptr);
  ~MissionControl() override { onboard_.executive.drain(); }  // no job may outlive its data

  /// Flies the mission.
  MissionResult run(const Watch& watch);
  /// The same without end().
  void fly(const Watch& watch);

  // The same in steps, for a team: begin once, advance until it returns false, end once.
  void begin(const Watch& watch);
  /// Flies on until `until`; false once the mission is over.
  bool advance(TimeNs until);
  MissionResult end();
  Phase phase() const { return phases_.phase(); }
  /// Brakes and lands at once, after a failure or at the operator's request, and does nothing else from then
  /// on. Allocates no memory.
  void land_now(const char* reason) noexcept;
  /// What was left out because a lane was late.
  const LoadShedding& load() const { return onboard_.load; }
  /// Why the vehicle went home; empty until then.
  const std::string& homing_reason() const { return return_home_.reason(); }

  void on_lidar(std::shared_ptr<const LidarScan> scan) override { sensors_.on_lidar(std::move(scan)); }
  void on_depth(std::shared_ptr<const DepthImage> image) override { sensors_.on_depth(image); }
  void on_rgb(const std::shared_ptr<const RgbFrame>& frame) override { sensors_.on_rgb(frame); }
  void on_pose(const PoseSample& s) override { sensors_.on_pose(s); }
  void on_objects(const ObjectDetections& look) override { objects_.on_objects(look); }
  // A message stamped in the future comes from a faulty clock and is ignored: it would make all later ones
  // look old.
  void on_imu(const ImuSample& s) override;
  void on_magnetometer(const MagnetometerSample& s) override {
    if (s.stamp <= now()) onboard_.flight.on_magnetometer(s);
  }
  void on_barometer(const BarometerSample& s) override {
    if (s.stamp <= now()) onboard_.flight.on_barometer(s);
  }
  void on_battery(const BatteryStatus& s) override { endurance_.note(s); }
  void on_ground(TimeNs stamp) override;
  void on_lift_off(TimeNs stamp) override;
  void on_gap() override;
  void on_authority(TimeNs stamp, Authority who, const std::string& reason) override;
  void on_lost(TimeNs stamp, MissionOutcome outcome, const std::string& reason) override;

 private:
  /// Its parts as a member of a team.
  struct InTeam {
    Teamwork& work;
    TeamSharing sharing;
    RightOfWay right_of_way;
    std::optional<RelayLanding> landing;  // empty if all land at their start
  };
  std::optional<InTeam> in_team(Teamwork* team);
  SensorPipeline::Wiring sensor_wiring();
  Exploration::Wiring exploration_wiring();
  ReturnHome::Wiring home_wiring();

  TimeNs latest_end() const;
  void control();
  void supervise();
  void fly_phase();
  void watch_steps();
  void shed_load();
  void report_to_watcher();
  void keep_safe();
  void note_verdict(const SafetyVerdict& before);
  void react(const SafetyVerdict& before);
  void take_off();
  void look();
  void end_flight(const char* reason, double max_path_m) noexcept;
  void land_here(const std::string& reason);
  void land();
  bool found_again() const;
  Vec3 home_after_hand_over(const Vec3& here) const;
  bool lands_at_home() const;
  bool checks_hold();
  std::string waits_for() const;
  void let_go(const std::string& reason);
  void wait_on_ground();
  void take_over();
  void forget_causes();
  MapQuestion map_question() const;
  void on_map(const MapNews& news);
  void leave_blocked_path(double after_m);
  void record();
  void note_speed_limit();
  void enter(Phase phase, const std::string& reason);
  void switch_off_motors(TimeNs stamp);
  void touch_down(TimeNs stamp);
  void finish_on_ground();
  void finish(MissionOutcome outcome, const std::string& reason);
  TimeNs now() const { return onboard_.now(); }

  Onboard onboard_;
  Vehicle& vehicle_;
  PhaseMachine phases_;
  FlownPath flown_path_;
  Endurance endurance_;
  GoalTracker goals_;
  PathExecution path_;
  TakeOff take_off_;
  std::optional<InTeam> team_;
  SensorPipeline sensors_;
  EarlierMapSearch earlier_map_;
  Exploration exploration_;
  Steering steering_;
  ReturnHome return_home_;
  ObjectSearch objects_;

  SafetySupervisor safety_;
  SafetyVerdict verdict_;
  SpeedLimit speed_limit_ = SpeedLimit::none;
  StepWatch control_watch_, supervision_watch_;
  Watch watch_;
  int overruns_ = 0;      // of the executive, as last recorded
  TimeNs lost_time_ = 0;  // likewise
  bool standing_ = true;
  Authority authority_;  // who steers
  std::string authority_reason_;
  Phase resumes_ = Phase::explore;        // when the core steers again
  std::string why_not_;                   // it may not fly
  bool lands_lost_ = false;               // for want of a pose
  std::optional<std::string> emergency_;  // why it lands at once, if it does
  std::optional<MissionResult> result_;
};

}  // namespace karst::core
