// Search for the order of places that covers a known set of cells soonest. What is measured is coverage
// averaged over the flight, and every place that a path passes counts, not only those that it goes to.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core_stack/common/random.h"

namespace karst::bound {

using Place = std::uint16_t;

/// 64 cells, of which those that are seen are set.
struct SeenWord {
  std::uint32_t word;
  std::uint64_t bits;
};

struct TourProblem {
  std::size_t places = 0, cells = 0;
  Place start = 0;
  std::vector<float> distance_m;            // [from * places + to]: along the shortest path, symmetric
  std::vector<Place> toward;                // [to * places + at]: the next place on it
  std::vector<std::vector<Place>> near;     // of each place, the places that are one step away
  std::vector<std::vector<SeenWord>> seen;  // of each place

  float distance(Place from, Place to) const { return distance_m[from * places + to]; }
  Place next(Place at, Place to) const { return toward[to * places + at]; }
};

/// A point mass that starts from rest, does not slow down in bends, and stands still from `end_s` on.
struct TourTiming {
  double speed_mps = 2, acceleration_mps2 = 2;
  double begin_s = 0;  // it starts to move; before, it sees what the first place shows
  double end_s = 0;
  double horizon_s = 0;  // coverage is averaged from 0 to here

  /// When it has flown so far.
  double arrival_s(double length_m) const;
  /// How far it has flown.
  double length_m(double time_s) const;
};

struct Tour {
  double mean_coverage = 0;
  std::vector<Place> targets;  // in order, without the start; what lies between is on the shortest paths
};

struct SearchOptions {
  int rounds = 200000;                                       // of annealing, each one changed order
  double first_temperature = 1e-3, last_temperature = 1e-5;  // in mean coverage
};

/// All places on the way, the start first, as far as the time reaches.
std::vector<Place> passed(const TourProblem& p, const TourTiming& t, std::span<const Place> targets);

/// Mean over the horizon of the share of cells seen.
double mean_coverage(const TourProblem& p, const TourTiming& t, std::span<const Place> targets);

/// Always to the place that shows the most new cells for its travel time, which is weighted by a drawn
/// exponent; then annealing. The same random stream gives the same tour.
Tour search_tour(const TourProblem& p, const TourTiming& t, const SearchOptions& options,
                 core::Random& random);

}  // namespace karst::bound
