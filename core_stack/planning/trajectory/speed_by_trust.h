// Speed by trust: no faster than what the sensors tell in time allows, and near rock no faster than the
// hull's gap to it allows.
#pragma once
#include <array>
#include <vector>

#include "core_stack/common/enum_names.h"

namespace karst::core {

/// What sets the speed at a moment of a trajectory. While the vehicle brakes, it is what it brakes for.
enum class SpeedLimit {
  none,        // it stands, turns on the spot, brakes in an emergency, or follows no path
  allowed,     // motion.max_speed, or what the policy or the safety supervisor allow
  sight,       // how far the sensors see the way
  room,        // rock beside the way
  narrow,      // narrow places
  bend,        // the acceleration across the path
  heading,     // the heading rate
  end,         // the end of the path, where it comes to rest
  speeding_up  // the acceleration along the path
};
constexpr auto names_of(SpeedLimit) {
  using enum SpeedLimit;
  return std::to_array<Named<SpeedLimit>>({{none, "none"},
                                           {allowed, "allowed"},
                                           {sight, "sight"},
                                           {room, "room"},
                                           {narrow, "narrow"},
                                           {bend, "bend"},
                                           {heading, "heading"},
                                           {end, "end"},
                                           {speeding_up, "speeding_up"}});
}

/// The greatest speed from which a vehicle stops within `free_m`, if it begins to brake after `reaction_s`:
///
///   v t + v^2 / (2 a) = d,  v = -a t + sqrt(a^2 t^2 + 2 a d)
double stopping_speed_mps(double free_m, double reaction_s, double braking_mps2);

/// The greatest speed at which the hull takes kGapTime_s to fly as far as rock beside it is away. At 2 m/s
/// this is the gap that the default clearance leaves, 0.2 m.
constexpr double kGapTime_s = 0.1;
double speed_beside_rock_mps(double gap_m);

/// Limits along a path, by the length that is left to its end: the rest of a path has the same ones.
struct TrustedSpeeds {
  double spacing_m = 0.5;
  std::vector<double> sight_mps, room_mps;  // the first at the end; empty: no limit

  double sight_at_mps(double to_end_m) const;
  double room_at_mps(double to_end_m) const;
};

}  // namespace karst::core
