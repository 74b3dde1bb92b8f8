// The order in which to visit a few places.
#pragma once
#include <vector>

namespace surface_coverage {

/// `gain[i]` is had on arriving at place i; `first_s[i]` is the time to it from here, `between_s[i][j]` from
/// i to j. Returns all places in the order that makes the sum of gain * exp(-arrival / patience_s) greatest:
/// an open tour, in which what is near and rich comes first. Every order is tried, by depth-first search with
/// a bound: for eight places at most, or so. Equal orders: the one lowest in places.
std::vector<std::size_t> best_order(const std::vector<double>& gain, const std::vector<double>& first_s,
                                    const std::vector<std::vector<double>>& between_s, double patience_s);

}  // namespace surface_coverage
