// Places that were tried in vain: they are not offered or accepted again until the map there has changed,
// and then only after a pause that doubles with every attempt.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core_stack/mapping/voxel_map.h"

namespace karst::core {

class GoalLedger {
 public:
  /// Notes that `place` was tried at `now` and why it is closed.
  void close(const VoxelMap& map, const Vec3& place, TimeNs now, const std::string& why);
  /// Why the place is closed, or nothing if it is open. The pause alone may decide, whether or not the map
  /// has changed.
  std::optional<std::string> closed(const VoxelMap& map, const Vec3& place, TimeNs now,
                                    bool by_pause_alone = false) const;

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
