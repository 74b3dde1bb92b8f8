// An open tour that collects much weight early: the order of stops with the smallest sum of weight times
// arrival time.
//
// That is the minimum latency problem (travelling repairman) with weights. A shortest tour delays the whole
// cave for the last corner of the chamber where it begins; here a small stop is worth a detour only while the
// delay of all the weight still ahead costs less than coming back for it.
#pragma once
#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace tour {

struct Problem {
  std::vector<double> weight;              // of each stop
  std::vector<double> first_s;             // time from the vehicle to each stop, the stop itself included
  std::vector<std::vector<double>> leg_s;  // [from][to] between stops; need not be symmetric
  std::size_t size() const { return weight.size(); }
};

using Order = std::vector<std::size_t>;

/// Sum over the stops of weight times arrival.
inline double latency(const Problem& p, const Order& order) {
  double sum = 0, t = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    t += i == 0 ? p.first_s[order[0]] : p.leg_s[order[i - 1]][order[i]];
    sum += p.weight[order[i]] * t;
  }
  return sum;
}

/// Starts with `first` and always continues to the stop with the most weight per time.
inline Order greedy(const Problem& p, std::size_t first) {
  Order order{first}, left;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (i != first) left.push_back(i);
  while (!left.empty()) {
    const auto rate = [&](std::size_t i) { return p.weight[i] / std::max(p.leg_s[order.back()][i], 1e-9); };
    const auto best = std::max_element(left.begin(), left.end(),
                                       [&](std::size_t a, std::size_t b) { return rate(a) < rate(b); });
    order.push_back(*best);
    left.erase(best);
  }
  return order;
}

/// Tries all 2-opt moves (reverse a segment) and Or-opt moves (move up to three stops, in either direction)
/// that leave the first `fixed` stops in place, and applies each that helps. False if none did.
inline bool sweep(const Problem& p, std::size_t fixed, Order& order, double& cost) {
  const std::size_t n = order.size();
  bool better = false;
  Order trial;
  const auto at = [](Order& o, std::size_t i) { return o.begin() + static_cast<std::ptrdiff_t>(i); };
  const auto consider = [&] {
    const double c = latency(p, trial);
    if (!(c < cost - 1e-9)) return;
    cost = c;
    order = trial;
    better = true;
  };
  for (std::size_t i = fixed; i < n; ++i)
    for (std::size_t j = i + 2; j <= n; ++j) {
      trial = order;
      std::reverse(at(trial, i), at(trial, j));
      consider();
    }
  for (std::size_t length = 1; length <= 3; ++length)
    for (std::size_t i = fixed; i + length <= n; ++i)
      for (std::size_t to = fixed; to + length <= n; ++to) {
        if (to == i) continue;
        trial = order;
        if (to < i)
          std::rotate(at(trial, to), at(trial, i), at(trial, i + length));
        else
          std::rotate(at(trial, i), at(trial, i + length), at(trial, to + length));
        Order reversed = trial;
        consider();
        if (length == 1) continue;
        std::reverse(at(reversed, to), at(reversed, to + length));
        trial = std::move(reversed);
        consider();
      }
  return better;
}

inline Order improved(const Problem& p, std::size_t fixed, Order order) {
  double cost = latency(p, order);
  while (sweep(p, fixed, order, cost)) {
  }
  return order;
}

/// A good tour that begins with `first`.
inline Order beginning_with(const Problem& p, std::size_t first) { return improved(p, 1, greedy(p, first)); }

/// A good tour: the best of the tours that begin with the few best first stops.
inline Order min_latency(const Problem& p) {
  constexpr std::size_t starts = 3;
  Order firsts(p.size());
  std::iota(firsts.begin(), firsts.end(), std::size_t{0});
  std::stable_sort(firsts.begin(), firsts.end(), [&](std::size_t a, std::size_t b) {
    return p.weight[a] * p.first_s[b] > p.weight[b] * p.first_s[a];
  });
  Order best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(starts, firsts.size()); ++i) {
    Order order = improved(p, 0, greedy(p, firsts[i]));
    if (const double cost = latency(p, order); cost < least) {
      least = cost;
      best = std::move(order);
    }
  }
  return best;
}

}  // namespace tour
