// Search for objects of interest: it feeds detections into the object map and reports the objects found, in
// the events, to the team, and at the end in objects.json.
#pragma once
#include <cstdint>
#include <map>

#include "core_stack/mission/onboard/onboard.h"
#include "core_stack/objects/object_map.h"
#include "core_stack/team/teamwork.h"

namespace karst::core {

class ObjectSearch {
 public:
  /// `team` is null if the vehicle flies alone.
  ObjectSearch(Onboard& onboard, Teamwork* team)
      : onboard_(onboard), team_(team), objects_(onboard.options.objects) {}

  void on_objects(const ObjectDetections& look);
  /// In a team: records for each object, once, that the base knows it.
  void note_at_base();
  /// Call at the end of the flight. `landed`: the vehicle can still report.
  void finish(bool landed);
  void write() const;

 private:
  enum class Report { what_changed, all };
  void report(Report which);

  Onboard& onboard_;
  Teamwork* team_;
  ObjectMap objects_;
  std::map<std::uint32_t, std::uint32_t>
      records_;  // by object: the first record about it; 0 once the base knows it
  bool late_looks_reported_ = false;
};

}  // namespace karst::core
