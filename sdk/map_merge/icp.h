// Iterative closest point with PCL: point to plane, from far to near.
#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include "sdk/map_merge/map_piece.h"

namespace karst::map_merge {

/// One stage: pairs points up to `reach_m` apart, with an even sample of the source's points.
struct IcpRound {
  double correspondence_m;
  int iterations;
  std::size_t max_points;
};

/// False if karst was built without PCL: then no Icp can be made.
bool has_icp();

/// Holds the target's search tree; PCL stays in icp.cpp.
class Icp {
 public:
  explicit Icp(const MapPiece& target);
  ~Icp();
  /// The pose at which ICP ends. It may be wrong: PCL reports failures as converged, too.
  core::Pose refine(const MapPiece& source, const core::Pose& T_target_source,
                    const std::vector<IcpRound>& rounds) const;

 private:
  struct Storage;
  std::unique_ptr<Storage> storage_;
};

}  // namespace karst::map_merge
