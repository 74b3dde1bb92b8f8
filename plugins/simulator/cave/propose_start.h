// A start for a cave that has none.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "plugins/simulator/cave/cave.h"

namespace karst::cave {

/// What a start must offer. The defaults suit the default vehicle and mission.
struct StartNeeds {
  double vehicle_radius_m = 0.3;
  double climb_m = 0.7;        // to the first hover, from where the vehicle stands
  double air_m = 1.5;          // least height from floor to roof
  double clearance_m = 0.7;    // least distance of the start to rock
  double max_slope_rad = 0.5;  // of the rock on which the vehicle comes to rest
};

/// A place in the air of the cave, above level floor, with room around it and a free climb, and the heading
/// of the longest horizontal sight from there. Candidates are columns of air spread over the cave, the
/// roomiest and most level first; the place must be inside by the rays of look_around(). Places that see a
/// hole of the mesh come last. The same for the same mesh; none if no candidate suits.
std::optional<StartPose> propose_start(const RayScene& scene, const StartNeeds& needs = {});

/// The first of the places above which, or at which, such a start lies: in the column of air through the
/// place. Places in rock do not suit, nor do those that see a hole of the mesh.
std::optional<StartPose> start_among(const RayScene& scene, const std::vector<core::Vec3>& places,
                                     const StartNeeds& needs = {});

/// As a cave file and --start have it: "x y z heading_deg", to the centimetre and degree.
std::string start_text(const StartPose& start);

}  // namespace karst::cave
