// Places that were tried and failed: they are not offered or accepted again until the map there has changed,
// and then only after a pause that doubles with every attempt.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core {

/// How a decision cycle judges whether a place is closed.
struct ClosureRules {
  TimeNs at = 0;                   // the pause must be over then; later than now waives some of it
  bool ignore_map_change = false;  // the pause alone decides
};

class GoalLedger {
 public:
  /// Notes that `place` was tried at `now` and why it is closed.
  void close(const VoxelMap& map, const Vec3& place, TimeNs now, const std::string& why);
  /// Why the place is closed, or nothing if it is open.
  std::optional<std::string> closed(const VoxelMap& map, const Vec3& place, const ClosureRules& rules) const;

 private:
  struct Entry {
    Vec3 place;
    std::uint64_t revision;  // of the map near it when it was closed
    TimeNs closed_until;     // at the least
    int attempts;
    std::string why;
  };
  std::vector<Entry> entries_;
};

}  // namespace karst::core
