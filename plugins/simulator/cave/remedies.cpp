#include "plugins/simulator/cave/remedies.h"

#include "plugins/simulator/cave/mesh_advice.h"
#include "plugins/simulator/cave/preflight.h"
#include "plugins/simulator/cave/propose_start.h"

namespace karst::cave {

std::string remedies(const RayScene& scene, const MeshFrame& frame, const std::optional<core::Vec3>& start) {
  std::string text;
  for (const MeshAdvice& a : mesh_advice(shape_of(scene), frame)) text += "; " + to_text(a);
  if (!text.empty()) return text;  // a start would be one in a wrong frame
  if (start) {
    const Surroundings s = look_around(scene, *start);
    if (s.odd_fraction >= 0.5 && s.clearance_m >= StartNeeds{}.vehicle_radius_m) return text;
  }
  if (const std::optional<StartPose> suits = propose_start(scene))
    text = "; a start that suits: --start \"" + start_text(*suits) + "\"";
  return text;
}

}  // namespace karst::cave
