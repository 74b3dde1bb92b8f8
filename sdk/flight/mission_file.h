// A mission file: all settings of `karst fly`, in Boost.PropertyTree INFO format.
//
//   seed 7
//   cave { file caves/demo.info }
//   policy { name nearest_frontier  parameters { horizon "60 m" } }
//   motion { max_speed "1.5 m/s" }
#pragma once
#include <array>
#include <boost/property_tree/ptree.hpp>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core_stack/common/enum_names.h"
#include "core_stack/mapping/occupancy/voxel_map.h"
#include "core_stack/mapping/region/region_keys.h"
#include "core_stack/mission/options/mission_options.h"
#include "core_stack/vehicle/mesh_keys.h"
#include "core_stack/vehicle/vehicle.h"
#include "sdk/flight/real_time_options.h"
#include "sdk/flight/team_faults.h"

namespace karst::flight {

/// Where the policy runs (docs/isolation.md): in a process of its own, in one if this machine can confine a
/// process, or in karst's.
enum class PolicyIsolation { where_possible, process, in_process };
constexpr auto names_of(PolicyIsolation) {
  using enum PolicyIsolation;
  return std::to_array<core::Named<PolicyIsolation>>(
      {{where_possible, "where_possible"}, {process, "process"}, {in_process, "in_process"}});
}

/// Settings of the command line that add to a mission file or override it.
struct MissionOverrides {
  std::string cave, start, policy, preset;                  // "" keeps the file's value
  std::vector<std::string> settings;                        // "key=value"
  std::vector<std::pair<std::string, std::string>> values;  // further keys with values
};

/// Keys of a survey that is known before the flight.
struct SurveyKeys {
  std::string file, offset;  // "": none; "": as the cave lies
  bool hints = true;
};

/// Keys of the map of an earlier flight.
struct EarlierMapKeys {
  std::string start, digest;  // "": none; "": whatever the file holds
};

/// What of the vehicle's messages the flight keeps (docs/run_directory.md).
struct RecordKeys {
  bool scans = false;
};

/// Another policy from a time of the flight on, by the vehicle's clock: policy.later.
struct LaterPolicy {
  double after_s = 0;
  std::string policy;
  boost::property_tree::ptree parameters;
  std::string selection;  // why, if it was selected; "" if it was named
};

void describe(core::OptionTable& table, LaterPolicy& later);

/// Decides at a stated time, from the map, which policy is to take over; nothing: the first goes on. The
/// second value says why in either case.
struct PolicyReview {
  double after_s = 0;
  std::function<std::pair<std::optional<LaterPolicy>, std::string>(const core::VoxelMap&)> choose;
};

struct Mission {
  std::string file;  // as named, for messages
  std::string cave, start, vehicle = "simulator", policy = "nearest_frontier";
  core::MeshKeys mesh;  // of a cave that is a bare mesh
  SurveyKeys survey;
  EarlierMapKeys earlier;
  core::RegionKeys region;
  RecordKeys record;
  std::int64_t seed = 1, policy_stream = 0;
  PolicyIsolation policy_isolation = PolicyIsolation::where_possible;
  double policy_cpu_limit_s = 10, policy_hang_limit_s = 60;
  std::int64_t policy_memory_limit_mib = 2048;
  core::CoreOptions core;
  TeamFaults faults;
  RealTimeOptions real_time;
  core::VehiclePlugin* vehicle_plugin = nullptr;
  boost::property_tree::ptree policy_parameters;
  boost::property_tree::ptree auto_policy;  // policy.auto, as given (auto_policy.h)
  std::string policy_selection;             // why this policy, if it was selected; "" if it was named
  std::optional<LaterPolicy> later;
  std::optional<PolicyReview> review;    // of `auto`, instead of `later`
  boost::property_tree::ptree resolved;  // every setting but the policy's parameters
};

/// The seed of the policy's own random stream: the mission's, or a different one for another `policy.stream`,
/// with which noise, gusts and faults stay the same.
std::uint64_t policy_seed(const Mission& mission);

/// A mission as stored in its run directory, with every setting resolved: `mission.info`. It can be flown
/// again unchanged.
boost::property_tree::ptree recorded_mission(const Mission& mission,
                                             const boost::property_tree::ptree& policy_parameters,
                                             const std::string& policy_version);

/// Reads a mission file, applies the overrides and checks the result. `file` may be "" for a mission given on
/// the command line only. Facts recorded in the file are ignored. Throws core::InputError naming file, key,
/// the expected value and the nearest key.
Mission read_mission(const std::string& file, const MissionOverrides& overrides);

/// The vehicle that the settings name, or else the mission file, or else the default.
std::string named_vehicle(const std::string& file, const MissionOverrides& overrides);

/// Every key with unit, range, default and a line of help, for a vehicle.
std::string mission_help(const std::string& vehicle);

}  // namespace karst::flight
