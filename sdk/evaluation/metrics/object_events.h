// Objects of interest in the events of a record.
#pragma once
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core_stack/common/geometry.h"
#include "core_stack/objects/object_state.h"

namespace karst::evaluation {

/// The ground truth of an object.
struct TrueObject {
  std::string what;
  core::Vec3 position = core::Vec3::Zero();
  bool seen = false;  // in view often enough to count as found
};

/// An object as known to a robot or the base.
struct KnownObject {
  std::string what;
  core::Vec3 position = core::Vec3::Zero();
  std::optional<double> reported_s;  // when it first became known to the base
};

/// By number.
using TrueObjects = std::map<std::int64_t, TrueObject>;
/// By robot, and the robot's own number for the object.
using KnownObjects = std::map<std::pair<std::int64_t, std::int64_t>, KnownObject>;

std::vector<TrueObject> listed(const TrueObjects& truth);
std::vector<KnownObject> listed(const KnownObjects& known);

/// The content of a report line; kind and position are not always repeated.
struct ObjectReport {
  core::ObjectState state;
  std::string what;
  std::optional<core::Vec3> position;
  double t_s = 0;
};

/// None if no object can be at this position: then it is damaged.
std::optional<core::Vec3> near_enough(const std::optional<core::Vec3>& position);
/// None if it is missing or damaged.
std::optional<core::Vec3> position_of(const nlohmann::json& event);
/// -1 if the field is not a whole number.
std::int64_t whole_number(const nlohmann::json& event, const char* key);

/// Reads truth_objects.jsonl.
TrueObjects true_objects(const std::vector<nlohmann::json>& events);

/// Applies a report; with the state `counts_as_reported` the object is known to the base.
void note(KnownObjects& known, const KnownObjects::key_type& key, const ObjectReport& report,
          std::optional<core::ObjectState> counts_as_reported);

}  // namespace karst::evaluation
