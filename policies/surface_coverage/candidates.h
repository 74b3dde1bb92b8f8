// Places to take pictures from: around patches of surface the camera has yet to see.
#pragma once
#include "account.h"

namespace surface_coverage {

/// Neighbouring cells that face the same way.
struct Patch {
  Vec3 center, normal;  // means; the normal is unit, or zero
  std::size_t cells = 0;
};

/// Grouped by cubes of `edge_m` and by the axis the normal is nearest to; in a fixed order.
std::vector<Patch> patches_of(const std::vector<SurfaceCell>& cells, double edge_m);

/// Clear places, with a heading, from which the patch's middle is in the camera's view, in its range, not too
/// much at a slant, and not hidden; at most `most`, squarest first. None where a fixed camera cannot look:
/// a ceiling straight above, a chimney's walls from below.
std::vector<Viewpoint> places_for(const karst::Request& request, const ImagingCamera& camera,
                                  const Patch& patch, std::size_t most);

/// Whether all cells that the vehicle's ball of clearance touches are free, for each place.
std::vector<bool> clear_places(const karst::Request& request, const std::vector<Vec3>& places);

}  // namespace surface_coverage
