// The conditions of flights beside the cave: vehicle, sensors, time and team. Figures compare under equal
// conditions only; what was learned under one may tell something about another (prediction.h).
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "sdk/selection/cave_figures.h"

namespace karst::selection {

using Settings = std::vector<std::pair<std::string, std::string>>;

/// The conditions under which flights of an experience were flown.
struct Condition {
  std::string name = {};                   // of this condition in its experience
  double horizon_s = 0;                    // the longest possible exploration: the limit of restricted times
  double endurance_s = 0;                  // the longest flight of one vehicle: its battery, or its time
  std::int64_t robots = 1;                 // in a team; 1: a vehicle alone
  std::string vehicle = {}, sensors = {};  // such as lidar_uav with os0_32; "": not known
  std::string profile = {};                // of the campaign
  Settings mission = {};                   // campaign::CampaignResults::shared
};

/// Fills in endurance, team, vehicle and sensors from horizon and settings, and then the name.
/// `flight_time`: mission.max_flight_time with its unit, "" if unknown.
void complete(Condition& condition, const std::string& flight_time, const std::string& source);

/// Whether flights under both may be put together: vehicle, sensors, time and team are the same.
bool same_kind(const Condition& a, const Condition& b);

/// What else differs, in words; "" if nothing does. A setting that only one of them has does not count: it
/// may come from another version of karst. Neither do settings that `same_kind` compares.
std::string difference(const Condition& a, const Condition& b);

/// The conditions of a mission for which a policy is selected, as far as they are given.
struct AskedConditions {
  std::string vehicle = {}, sensors = {};  // "": not given
  double endurance_s = kUnknown;           // NaN: not given
  std::int64_t robots = 0;                 // 0: not given
};
AskedConditions asked(const Condition& condition);

/// Whether the condition is what is asked for: endurance within 25 %, all else equal or not given.
bool meets(const Condition& condition, const AskedConditions& asked);

/// "camera_uav, 480 s, a team of 3".
std::string in_words(const Condition& condition);
std::string in_words(const AskedConditions& asked);

}  // namespace karst::selection
