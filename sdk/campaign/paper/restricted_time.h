// Restricted times in tables: whether the flights behind a mean reached the coverage at all.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "sdk/campaign/store/results.h"

namespace karst::campaign {

/// Whether a flight counts with the horizon if it did not reach what the figure is the time of.
bool is_restricted_time(int metric);

/// Of the flights behind a contestant's mean (`comparable_figures`), how many reached it before the horizon.
struct Reached {
  std::size_t reached = 0, flights = 0;
  bool never() const { return flights > 0 && reached == 0; }
  bool by_some() const { return reached > 0 && reached < flights; }
};
std::vector<Reached> reached_by(const CampaignResults& results, int metric);

/// "nearest 3 of 12": contestants of which only some flights reached it, in the order given; "" if none.
std::string reached_by_some_text(const CampaignResults& results, const std::vector<std::size_t>& order,
                                 const std::vector<Reached>& by_contestant);

/// Whether a mean of restricted times is the horizon: no flight behind it reached the coverage.
bool is_horizon(double mean_s, double horizon_s);

/// "Time to 50 % coverage is a restricted mean time: a flight that did not reach the coverage counts with the
/// horizon (300 s)".
std::string restricted_text(const std::vector<int>& metrics, double horizon_s);

}  // namespace karst::campaign
