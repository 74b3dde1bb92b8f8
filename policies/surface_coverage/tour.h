// The order in which to visit a few stops.
#pragma once
#include <vector>

namespace surface_coverage {

/// `gain[i]` is collected on arrival at stop i; `first_s[i]` is the time from the vehicle to stop i,
/// `between_s[i][j]` from i to j. Returns all stops in the order with the largest sum of
/// gain * exp(-arrival / patience_s): an open tour in which near and rich stops come first. Branch and bound
/// over all orders, for about eight stops at most. Of equal orders, returns the lexicographically smallest.
std::vector<std::size_t> best_order(const std::vector<double>& gain, const std::vector<double>& first_s,
                                    const std::vector<std::vector<double>>& between_s, double patience_s);

}  // namespace surface_coverage
