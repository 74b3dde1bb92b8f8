// Positions where goals have failed. They are not offered or accepted again until the map there has changed,
// and not before a pause that doubles with every attempt.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core_stack/mapping/occupancy/voxel_map.h"

namespace karst::core {

/// How a decision cycle judges whether a place is closed.
struct ClosureRules {
  TimeNs at = 0;                   // when the pause must be over; later than now waives part of it
  bool ignore_map_change = false;  // the pause alone decides
};

class GoalLedger {
 public:
  /// Closes `place` after an attempt at `now`, for the reason `why`.
  void close(const VoxelMap& map, const Vec3& place, TimeNs now, const std::string& why);
  /// Why the place is closed, or nothing if it is open.
  std::optional<std::string> closed(const VoxelMap& map, const Vec3& place, const ClosureRules& rules) const;

 private:
  struct Entry {
    Vec3 place;
    std::uint64_t revision;  // of the map near it when it was closed
    TimeNs closed_until;     // at least
    int attempts;
    std::string why;
  };
  std::vector<Entry> entries_;
};

}  // namespace karst::core
