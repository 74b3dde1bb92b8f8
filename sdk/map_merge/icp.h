// Iterative closest point with PCL: point to plane, from far to near.
#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include "core_stack/mapping/registration/map_registration.h"

namespace karst::map_merge {

using core::IcpRound;
using core::MapPiece;

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
