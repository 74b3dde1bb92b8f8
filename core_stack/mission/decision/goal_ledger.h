// Positions where goals have failed. They are not offered or accepted again until the map there has changed,
// and not before a pause that doubles with every attempt. Where only the way there was not good, they are
// open again after a short pause: the next way begins elsewhere.
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
  /// Closes `place` for two seconds, because it cannot be flown to from where the vehicle is at `now`. After
  /// four such pauses in all it is closed like any other.
  void pause(const VoxelMap& map, const Vec3& place, TimeNs now, const std::string& why);
  /// Why the place is closed, or nothing if it is open.
  std::optional<std::string> closed(const VoxelMap& map, const Vec3& place, const ClosureRules& rules) const;

 private:
  struct Entry {
    Vec3 place;
    std::optional<std::uint64_t> revision;  // of the map near it when it was closed; only the pause counts
    TimeNs closed_until;                    // at least
    int attempts;                           // that closed it
    int pauses;
    std::string why;
  };
  Entry& entry_of(const Vec3& place);

  std::vector<Entry> entries_;
};

}  // namespace karst::core
