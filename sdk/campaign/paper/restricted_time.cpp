#include "sdk/campaign/paper/restricted_time.h"

#include "sdk/campaign/paper/printed_figure.h"
#include "sdk/campaign/verdict/figure_words.h"
#include "sdk/campaign/verdict/verdict.h"

namespace karst::campaign {

bool is_restricted_time(int metric) {
  return evaluation::metric_definitions()[static_cast<std::size_t>(metric)].if_failed ==
         evaluation::IfFailed::horizon;
}

std::vector<Reached> reached_by(const CampaignResults& results, int metric) {
  std::vector<Reached> by_contestant;
  for (const auto& by_cave : comparable_figures(results, metric)) {
    Reached& r = by_contestant.emplace_back();
    for (const auto& cave : by_cave)
      for (const double time_s : cave) {
        ++r.flights;
        r.reached += time_s < results.horizon_s;
      }
  }
  return by_contestant;
}

std::string reached_by_some_text(const CampaignResults& results, const std::vector<std::size_t>& order,
                                 const std::vector<Reached>& by_contestant) {
  std::vector<std::string> parts;
  for (const std::size_t i : order)
    if (const Reached& r = by_contestant[i]; r.by_some())
      parts.push_back(results.contestants[i].name + " " + std::to_string(r.reached) + " of " +
                      std::to_string(r.flights));
  return listed(parts);
}

bool is_horizon(double mean_s, double horizon_s) {
  constexpr double kRounding = 1e-9;  // of a mean of equal numbers
  return mean_s >= horizon_s * (1 - kRounding);
}

std::string restricted_text(const std::vector<int>& metrics, double horizon_s) {
  if (metrics.empty()) return "";
  std::vector<std::string> names;
  for (const int metric : metrics)
    names.push_back(names.empty() ? printed_figure(metric).heading : printed_figure(metric).subject);
  return listed(names) + (names.size() == 1 ? " is a restricted mean time" : " are restricted mean times") +
         ": a flight that did not reach the coverage counts with the horizon (" + fixed_text(horizon_s, 0) +
         " s)";
}

}  // namespace karst::campaign
