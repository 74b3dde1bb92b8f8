// Iterative closest point with PCL: point to plane, from far to near.
#pragma once
#include <memory>

#include "sdk/map_merge/map_piece.h"

namespace karst::map_merge {

/// One round: pairs of points up to `reach_m` apart, of the source's points an even pick.
struct IcpRound {
  double correspondence_m;
  int iterations;
  std::size_t max_points;
};

/// Holds the target's search tree; PCL stays in icp.cpp.
class Icp {
 public:
  explicit Icp(const MapPiece& target);
  ~Icp();
  /// Where ICP ends. Nothing is said of whether that is right: PCL calls failures converged, too.
  core::Pose refine(const MapPiece& source, const core::Pose& T_target_source,
                    const std::vector<IcpRound>& rounds) const;

 private:
  struct Storage;
  std::unique_ptr<Storage> storage_;
};

}  // namespace karst::map_merge
