// Objects of interest as the events of a record have them.
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

/// An object as it truly lies.
struct TrueObject {
  std::string what;
  core::Vec3 position = core::Vec3::Zero();
  bool seen = false;  // in view often enough to be found
};

/// An object as somebody knows it.
struct KnownObject {
  std::string what;
  core::Vec3 position = core::Vec3::Zero();
  std::optional<double> reported_s;  // when the base first knew of it
};

/// By number.
using TrueObjects = std::map<std::int64_t, TrueObject>;
/// By robot, and its own number for the object.
using KnownObjects = std::map<std::pair<std::int64_t, std::int64_t>, KnownObject>;

std::vector<TrueObject> listed(const TrueObjects& truth);
std::vector<KnownObject> listed(const KnownObjects& known);

/// What a line says of an object; what and where are not always said again.
struct ObjectReport {
  core::ObjectState state;
  std::string what;
  std::optional<core::Vec3> position;
  double t_s = 0;
};

/// None if it lies where no object can be: then it is damaged.
std::optional<core::Vec3> near_enough(const std::optional<core::Vec3>& position);
/// None if it is missing or damaged.
std::optional<core::Vec3> position_of(const nlohmann::json& event);
/// -1 if it is none.
std::int64_t whole_number(const nlohmann::json& event, const char* key);

/// Of truth_objects.jsonl.
TrueObjects true_objects(const std::vector<nlohmann::json>& events);

/// Takes in a report; with the state `counts_as_reported` the base knows of the object.
void note(KnownObjects& known, const KnownObjects::key_type& key, const ObjectReport& report,
          std::optional<core::ObjectState> counts_as_reported);

}  // namespace karst::evaluation
