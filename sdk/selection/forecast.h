// What a flight of a given length can be expected to explore in a cave of a given size, from flights in other
// caves. The time to explore a cave goes with the length of its passages: a flight of t in a cave of length L
// is compared with the first t L_c / L of the flights in a known cave of length L_c (docs/preflight.md).
#pragma once
#include "sdk/selection/select.h"

namespace karst::selection {

/// The time that a flight has, after take-off.
struct FlightTime {
  double endurance_s = 0;      // what it is given
  double explore_s = 0;        // until it turns back at the latest
  double flight_s = 0;         // until it has landed at the latest
  double up_down_s = 0;        // of these, to climb to the first hover and to land
  double max_speed_mps = 1e9;  // of the vehicle; a slower one than that of the known flights takes longer
};

/// NaN: unknown.
struct Forecast {
  double coverage = kUnknown;
  double flight_s = kUnknown;  // to the landing
  double path_m = kUnknown;
  double energy_wh = kUnknown;
};

/// Weighted means over the caves with the weights of the selection. Nothing is expected beyond what the time
/// allows: the flight ends at time.flight_s, and path and energy follow from its time, the speed and the
/// power of the known flights.
Forecast forecast(const Experience& experience, const CaveFigures& cave, const Selected& selected,
                  std::size_t contestant, const FlightTime& time);

}  // namespace karst::selection
