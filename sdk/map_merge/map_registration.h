// Registration of two maps by PCL's ICP, in six degrees of freedom. docs/map_merge.md
#pragma once
#include "core_stack/mapping/registration/map_registration.h"
#include "sdk/map_merge/icp.h"

namespace karst::map_merge {

using core::MapPiece;
using core::MapRegistration;
using core::MapRegistrationOptions;
using core::piece_of;
using core::PlaceDescriptor;

inline MapRegistration register_maps(const MapPiece& target, const MapPiece& source,
                                     const MapRegistrationOptions& options) {
  const Icp icp(target);
  return core::register_maps(
      target, source, options,
      [&icp](const MapPiece& piece, const core::Pose& T_target_source, const std::vector<IcpRound>& rounds) {
        return icp.refine(piece, T_target_source, rounds);
      });
}

}  // namespace karst::map_merge
