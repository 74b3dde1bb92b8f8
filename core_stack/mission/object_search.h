// Objects of interest: what the detector says goes into the object map, and what that finds is told: in the
// events, to the team, and at the end in objects.json.
#pragma once
#include <cstdint>
#include <map>

#include "core_stack/mission/onboard/onboard.h"
#include "core_stack/objects/object_map.h"
#include "core_stack/team/teamwork.h"

namespace karst::core {

class ObjectSearch {
 public:
  /// `team` is null for a vehicle that flies alone.
  ObjectSearch(Onboard& onboard, Teamwork* team)
      : onboard_(onboard), team_(team), objects_(onboard.options.objects) {}

  void on_objects(const ObjectDetections& look);
  /// In a team: tells of each object once that the base knows it.
  void note_at_base();
  /// The flight is over. `landed`: it can report where it stands.
  void finish(bool landed);
  void write() const;

 private:
  enum class Report { what_changed, all };
  void report(Report which);

  Onboard& onboard_;
  Teamwork* team_;
  ObjectMap objects_;
  std::map<std::uint32_t, std::uint32_t> records_;  // by object: that told of it first; 0 once the base knows
  bool late_looks_reported_ = false;
};

}  // namespace karst::core
