// Mission control: the top loop. Sensor messages come in, the policy's goals become paths, paths become
// commands; and whatever happens, the vehicle comes home and lands.
//
//   standby -> takeoff -> (look) -> explore -> home -> land -> done
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/common/executive.h"
#include "core_stack/homing/encounter.h"
#include "core_stack/homing/home.h"
#include "core_stack/mapping/moving_bodies.h"
#include "core_stack/mission/explorer.h"
#include "core_stack/mission/flight.h"
#include "core_stack/mission/recorder.h"
#include "core_stack/mission/step_watch.h"
#include "core_stack/mission/teamwork.h"
#include "core_stack/objects/object_map.h"
#include "core_stack/planning/polynomial_trajectory.h"

namespace karst::core {

/// A scan counts in the map this long after it came in.
constexpr TimeNs kMappingBudget = 60 * kMillisecond;

/// A new path is joined to the one under way by a curve that leaves out the corner by no more than this.
constexpr double kMostCut_m = 0.3;

enum class Phase { standby, takeoff, look, explore, home, land, done };
const char* name_of(Phase phase);

/// For a person watching.
struct MissionStatus {
  TimeNs time = 0;
  Phase phase = Phase::standby;
  double battery_fraction = 1, battery_seconds_left = 0, explored_m3 = 0, speed_mps = 0;
  std::string goal;
};

/// Called every second of flight; returns false to have the vehicle land where it is.
using Watch = std::function<bool(const MissionStatus&)>;

struct MissionResult {
  std::string outcome;  // landed | contact | stuck | battery | aborted
  std::string reason;
  bool stands = false;              // whole, on the ground
  std::string record_problem = {};  // why the run directory is not complete; empty if it is
};

class MissionControl final : public VehicleSink {
 public:
  MissionControl(const CoreOptions& options, Vehicle& vehicle, Executive& executive, PolicyPort& policy,
                 Recorder& recorder, Teamwork* team = nullptr);
  ~MissionControl() override { executive_.drain(); }  // no job may outlive what it works on

  /// Flies the mission.
  MissionResult run(const Watch& watch);
  /// The same but for end().
  void fly(const Watch& watch);

  // The same in steps, for a team: begin once, advance until it returns false, end once.
  void begin(const Watch& watch);
  /// Flies on until `until`; false once the mission is over.
  bool advance(TimeNs until);
  MissionResult end();
  Phase phase() const { return phase_; }
  /// For what failed, or at the operator's wish: it brakes and lands where it is, and does nothing else any
  /// more. Needs no memory.
  void land_now(const char* reason) noexcept;
  /// Why it went home; empty until then.
  const std::string& homing_reason() const { return homing_reason_; }

  void on_lidar(std::shared_ptr<const LidarScan> scan) override;
  void on_depth(std::shared_ptr<const DepthImage> image) override;
  void on_rgb(std::shared_ptr<const RgbFrame> frame) override;
  void on_objects(const ObjectDetections& look) override;
  // What is stamped later than now is of a clock gone wrong: taken in, it would make all that follows look
  // old.
  void on_imu(const ImuSample& s) override;
  void on_magnetometer(const MagnetometerSample& s) override {
    if (s.stamp <= now()) flight_.on_magnetometer(s);
  }
  void on_barometer(const BarometerSample& s) override {
    if (s.stamp <= now()) flight_.on_barometer(s);
  }
  void on_pose(const PoseSample& s) override {
    if (!loam_ && s.stamp <= now()) flight_.on_pose(s);
  }
  void on_battery(const BatteryStatus& s) override { battery_ = s; }
  void on_ground(TimeNs stamp, bool standing) override;
  void on_lost(TimeNs stamp, const std::string& outcome, const std::string& reason) override;

 private:
  void control();
  void watch_steps();
  void supervise();
  void keep_safe();
  void end_take_off();
  void choose_hover();
  void brake();
  bool braked_since(TimeNs t) const;
  void record();
  void enter(Phase phase, const std::string& reason);
  void touch_down(TimeNs stamp);
  void finish_on_ground();
  void finish(const std::string& outcome, const std::string& reason);

  // Localization and mapping.
  void note_localization(const LoamPose& pose, bool accepted);
  void keep_picture(const std::shared_ptr<const RgbFrame>& frame, const std::string& file);
  void map_scan(std::shared_ptr<const LidarScan> scan);
  void integrate(std::function<std::vector<Ray>()> make_rays);
  void on_map_update(const std::vector<CellChange>& changes, std::optional<double> blocked_after_m,
                     bool goal_alive);

  /// A path as it is flown.
  struct Route {
    Path path;
    std::vector<Vec3> points;  // the stretch of the trajectory that leads to the path, and the path
    HeadingPlan heading;
    double start_speed_mps = 0, max_speed_mps = 0;
    SlowPlaces slow;
    std::optional<PolynomialTrajectory> polynomial;  // along the points, if the mission flies those
    Trajectory sampled;  // along the points, within `limits`; its start is not set
    MotionLimits limits;
  };

  // Objects of interest.
  void tell_objects(bool all);
  void note_objects_at_base(std::uint32_t records_at_base);
  void settle_objects(bool landed);
  void write_objects();

  // Exploring.
  void explore();
  void begin_round(bool appending);
  std::vector<Vec3> way_to(const Flight::Onward& lead) const;
  void on_round(const RoundInput& input, const RoundResult& result, const Route& way);
  void settle_goal(GoalFate fate, PolicyEvent::Kind kind, const std::string& reason);
  void drop_next_goal(PolicyEvent::Kind kind, const std::string& reason);
  bool within_tolerance(const Goal& goal) const;
  void record_round(const RoundInput& input, const RoundResult& result);

  /// On the map lane: joins a path to its lead, whose end it passes by no more than `most_cut_m`. It will be
  /// followed from `start` on, within `within`; `narrow_before` are the narrow places the lead may pass.
  /// `passed` is the goal that the lead ends at, if any.
  Route route(const Flight::Onward& lead, const Path& path, const std::optional<Goal>& goal,
              const std::optional<Goal>& passed, TimeNs start, double most_cut_m, const MotionLimits& within,
              const std::vector<Vec3>& narrow_before) const;
  void follow(const Route& way);

  // Going home and landing.
  double seconds_left() const;
  void begin_homing(const std::string& reason);
  void watch_battery();
  void go_home();
  void plan_home_path();
  void fly_back_as_come();
  void land();
  void watch_progress();

  // In a team.
  void share();
  void drop_node(const NodeDrop& drop);
  void report_state();
  void choose_landing();
  void confirm_landing();
  void give_up_landing(const std::string& reason, bool unheard = false);
  void keep_apart();
  void make_room(const std::vector<Neighbour>& others);
  std::vector<MovingBody> others_at(TimeNs stamp) const;
  bool in_company() const;
  bool airspace_clear() const;
  void claim_goal(const std::optional<Goal>& goal);
  void become_relay();
  /// Where it flies to when it goes home, and comes down.
  const Vec3& landing_hover() const { return landing_ ? landing_->hover : home_; }

  TimeNs now() const { return executive_.now(); }
  std::vector<Vec3> path_ahead() const;

  CoreOptions options_;
  VehicleDescription description_;
  Vehicle& vehicle_;
  Executive& executive_;
  Recorder& recorder_;
  Teamwork* team_;  // null: it flies alone
  Watch watch_;
  Flight flight_;
  StepWatch control_watch_, supervision_watch_;
  SafetySupervisor safety_;
  SafetyVerdict verdict_;
  std::optional<Loam> loam_;  // on vehicles with a LiDAR; touched by jobs on the localization lane only
  Explorer explorer_;         // touched by jobs on the map lane only

  Phase phase_ = Phase::standby;
  TimeNs phase_since_ = 0;
  std::optional<MissionResult> result_;
  BatteryStatus battery_;
  bool has_taken_off_ = false, standing_ = true;
  bool hover_chosen_ = false;             // below a roof that stopped the take-off
  std::optional<std::string> emergency_;  // why it lands at once, if it does

  // The goal under way, and what the policy has yet to be told.
  std::optional<Goal> goal_;
  std::optional<Goal> next_goal_;  // appended behind goal_
  GoalFate last_fate_ = GoalFate::none;
  std::optional<Goal> last_goal_;
  std::vector<PolicyEvent> events_;
  std::vector<std::uint32_t> looked_at_;
  bool round_running_ = false, append_tried_ = false, goal_alive_ = true;
  std::vector<Vec3> narrow_places_;  // of the path under way, and of what it was joined to
  bool path_limited_ = false;        // the path under way has a speed limit of its own
  std::optional<TimeNs> braked_at_;
  bool path_blocked_ = false;  // it brakes, or stands, before a place that is closed now
  bool detour_due_ = false;    // the path is closed farther on: a new one is due, there is no need to stop
  TimeNs tight_until_ = 0;     // until then the path leads out of a place tighter than it should be
  TimeNs last_round_ = 0, last_landmark_time_ = 0;
  Vec3 last_landmark_ = Vec3::Zero();  // for judging progress

  // The way home.
  Vec3 home_ = Vec3::Zero();  // the first hover
  std::vector<Vec3> flown_;   // the way come, a pose every quarter of a metre
  double flown_m_ = 0;
  double home_distance_m_ = 0;
  TurnBack turn_back_;
  std::string homing_reason_;
  int home_failures_ = 0;
  bool home_planning_ = false;
  bool flying_as_come_ = false;  // back along the poses flown: only what it would touch stops it

  ObjectMap objects_;
  std::map<std::uint32_t, std::uint32_t> records_;  // by object: that told of it first; 0 once the base knows
  bool late_looks_told_ = false;

  // In a team.
  std::optional<LandingSpot> landing_;   // where it will be a relay; without, it lands at its start
  std::optional<TimeNs> landing_again_;  // it comes to that place too late: when to look for another
  std::int64_t nodes_left_ = 0;          // that it carries
  std::optional<TimeNs> dropped_at_;
  std::optional<TimeNs> unheard_since_;  // it hovers there and hears nobody who reaches the base
  Encounter encounter_;                  // with another vehicle
  Refuge refuge_;                        // where it last made room
  std::vector<Vec3> refuges_in_vain_;    // the other did not get by there
  bool planning_aside_ = false;
  TimeNs home_retry_ = 0;  // no way home, with another vehicle near: it is asked for again then

  double explored_m3_ = 0;
  std::optional<double> hull_clearance_m_;
  int overruns_ = 0;                                     // of the executive, as last noted
  TimeNs last_seen_ = 0;                                 // when a scan or an image was last taken in
  int pictures_lost_ = 0;                                // not kept
  std::string localization_state_, believed_ = "lidar";  // as last noted in the events
};

}  // namespace karst::core
