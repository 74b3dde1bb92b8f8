// All settings of the core stack in one struct and one table: the mission file's sections.
#pragma once
#include <memory>

#include "core_stack/control/mpc_tracker.h"
#include "core_stack/control/se3_controller.h"
#include "core_stack/localization/localization_options.h"
#include "core_stack/mapping/frontiers/frontiers.h"
#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/mapping/prior/earlier_map.h"
#include "core_stack/mapping/prior/surveyed_passages.h"
#include "core_stack/mapping/region/flight_region.h"
#include "core_stack/mission/options/safety_options.h"
#include "core_stack/objects/object_options.h"
#include "core_stack/perception/intensity_filter.h"
#include "core_stack/planning/path/path.h"
#include "core_stack/planning/trajectory/trajectory.h"
#include "core_stack/team/team_options.h"
#include "core_stack/vehicle/vehicle.h"

namespace karst::core {

/// The latency from a scan's arrival to its integration into the map.
constexpr TimeNs kMappingBudget = 60 * kMillisecond;

struct MissionOptions {
  double takeoff_height_m = 0.7;
  double launch_clear_radius_m = 1.0;
  double decision_period_s = 4.0;
  double decision_budget_s = 0.3;
  bool append = true;
  double append_before_s = 2.5;
  double goal_timeout_s = 10.0;
  double explored_patience_s = 5.0;
  double home_margin = 0.15;
  double home_reserve_s = 20.0;
  double landing_speed_mps = 0.4;
  double max_flight_time_s = 3600.0;
  double mapping_range_m = 30.0;
  std::int64_t min_open_cells = 4;
};
void describe(OptionTable& t, MissionOptions& o);

/// What a survey tells of the cave. It stands in no table: who flies the mission reads the survey.
struct KnownSurvey {
  std::shared_ptr<const SurveyedPassages> passages;  // null: the mission has no survey
  bool told_to_policy = true;                        // else it is only counted what it lacks
};

/// The map of an earlier flight, in which this one looks for its place. It stands in no table: who flies the
/// mission reads the map, and describes its keys.
struct KnownMap {
  std::shared_ptr<const EarlierMap> map;  // null: the mission has none
  bool required = false;                  // without its place in it, the vehicle lands before it explores
  double search_time_s = 120;             // after take-off, how long it looks for its place
};

struct CoreOptions {
  MissionOptions mission;
  SafetyOptions safety;
  MapOptions map;
  FrontierOptions frontiers;
  IntensityFilterOptions perception;
  LocalizationOptions localization;
  ObjectOptions objects;
  PlanningOptions planning;
  MotionLimits motion;
  MpcOptions tracker;
  Se3Options controller;
  TeamOptions team;  // described separately: a single vehicle has none
  HomingOptions homing;
  KnownSurvey survey;
  KnownMap earlier;
  std::shared_ptr<const FlightRegion> region;  // null: it may fly everywhere; described by RegionKeys
};
void describe(OptionTable& t, CoreOptions& o);

/// Throws InputError if individually valid settings contradict each other or do not fit the vehicle.
void check(const CoreOptions& o, const VehicleDescription& vehicle);

/// Throws InputError with `source` if the region leaves no room for the vehicle where it stands, above that,
/// or where it hovers after take-off.
void check_region(const std::string& source, const CoreOptions& o, const VehicleDescription& vehicle);

/// How deep inside the region a place must lie so that a path can begin and end there.
double min_hover_depth_m(const CoreOptions& o);

}  // namespace karst::core
