// Stands in for icp.cpp in a build without PCL.
#include <stdexcept>

#include "sdk/map_merge/icp.h"

namespace karst::map_merge {

struct Icp::Storage {};

bool has_icp() { return false; }

Icp::Icp(const MapPiece&) { throw std::logic_error("built without PCL: has_icp() must be asked first"); }
Icp::~Icp() = default;

core::Pose Icp::refine(const MapPiece&, const core::Pose& T_target_source,
                       const std::vector<IcpRound>&) const {
  return T_target_source;  // never called: there is no Icp to call it of
}

}  // namespace karst::map_merge
