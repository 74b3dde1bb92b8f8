// Viewpoints for pictures, around patches of surface that are not imaged yet.
#pragma once
#include "account.h"

namespace surface_coverage {

/// Neighbouring cells that face the same way.
struct Patch {
  Vec3 center, normal;  // means; the normal is unit, or zero
  std::size_t cells = 0;
};

/// Groups cells by cubes of `edge_m` and by the axis nearest to the normal; in a fixed order.
std::vector<Patch> patches_of(const std::vector<SurfaceCell>& cells, double edge_m);

/// Clear viewpoints from which the patch's centre is in the camera's field of view and range, within its
/// largest incidence, and not hidden; at most `most`, the most frontal first. None where a fixed camera
/// cannot look: a ceiling straight above, a chimney's walls from below.
std::vector<Viewpoint> places_for(const karst::Request& request, const ImagingCamera& camera,
                                  const Patch& patch, std::size_t most);

/// For each position, whether all cells within the request's clearance of it are free.
std::vector<bool> clear_places(const karst::Request& request, const std::vector<Vec3>& places);

}  // namespace surface_coverage
