// Where to land as a relay: on ground that is flat and clear, in reach of the relays there are, as far beyond
// them as that allows, out of the others' way.
#pragma once
#include <array>
#include <vector>

#include "core_stack/homing/landing_ground.h"
#include "core_stack/homing/link_estimate.h"
#include "core_stack/planning/roadmap.h"
#include "core_stack/planning/trajectory.h"

namespace karst::core {

struct LandingOptions {
  GroundOptions ground;
  LinkEstimateOptions link;
  double least_extension_m = 5.0;  // from every communication node there is
  double keep_apart_m = 2.0;       // from places that others stand at, claimed or hover at
  double passage_reach_m = 3.0;    // others must get by within that
  double second_link_m = 5.0;      // a second node in reach is worth that much extension
  double second_m = 0.5;           // and so is a second of flight less
  double landing_speed_mps = 0.4;
  std::int64_t most_places = 4;
};
void describe(OptionTable& t, LandingOptions& o);

struct LandingRequest {
  Vec3 from = Vec3::Zero();  // where the vehicle is
  std::vector<Vec3> around;  // candidates lie within `reach_m` of these: the homing route, thinned
  double reach_m = 4.0;
  double most_time_s = 1e9;  // flight and descent may take so long
  std::vector<Vec3> nodes;   // antennas of the communication nodes that reach the base
  std::vector<Vec3> others;  // kept apart from
  double vehicle_radius_m = 0.3;
};

struct LandingPlace {
  Vec3 hover = Vec3::Zero(), ground = Vec3::Zero();  // straight below
  double slope_rad = 0, step_m = 0;
  std::size_t nearest_node = 0;  // index in `nodes`
  double extension_m = 0;        // distance to it
  double margin_db = 0;          // of the best link, spare already taken off
  std::size_t links = 0;         // that can be counted on
  double time_s = 0;             // flight and descent
  double score = 0;              // metres of extension, and what is worth as much
};

/// Why candidates were refused, in the order they are looked at.
enum class LandingRefusal {
  ground,
  out_of_reach,
  no_extension,
  too_near_others,
  no_way,
  no_time,
  in_the_way
};
constexpr std::size_t kLandingRefusals = 7;
const char* landing_refusal_text(LandingRefusal r);

struct LandingSearch {
  std::vector<LandingPlace> places;  // best first, at most most_places
  std::size_t candidates = 0;
  std::array<std::size_t, kLandingRefusals> refused{};
};

/// Candidates are the roadmap's nodes near `around` with ground below. The two dear questions are asked last:
/// the ways to all candidates in one search, and whether others get by, best candidate first, until enough
/// are found.
LandingSearch find_landing_places(const VoxelMap& map, const Roadmap& roadmap, const LandingRequest& request,
                                  const LandingOptions& options, const PlanningOptions& planning,
                                  const MotionLimits& limits);

}  // namespace karst::core
