// The parts of the campaign page's data (docs/report.md).
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sdk/campaign/store/results.h"
#include "sdk/campaign/verdict/verdict.h"

namespace karst::campaign {

/// A number with six significant digits, or null if it is unknown.
nlohmann::ordered_json number_or_null(double v);

/// Interval of the mean of `values` by cave: over seeds, or over caves if a cave has too few seeds. Clamped
/// to the possible range of the figure, which the widening for few seeds may exceed.
struct MeanInterval {
  evaluation::Interval interval;
  bool over_caves = false;
};
MeanInterval mean_interval(const evaluation::Differences& values, const VerdictOptions& options,
                           int resamples, const evaluation::Interval& possible);

/// Verdicts, ranking, and comparisons of every pair of contestants in every figure.
nlohmann::ordered_json report_verdicts(const Verdicts& verdicts);

/// Summary of each contestant's trials in one figure: [contestant] -> {all, caves}, each with n, mean and
/// interval or null. Caves have equal weight.
nlohmann::ordered_json report_summary(const CampaignResults& results, const VerdictOptions& options,
                                      int metric);

/// The same of all figures: [figure][contestant].
nlohmann::ordered_json report_summaries(const CampaignResults& results, const VerdictOptions& options);

/// Coverage and explored volume over time on one time grid: of every trial, and means with intervals by
/// contestant, for each cave and over all.
nlohmann::ordered_json report_curves(const CampaignResults& results, const VerdictOptions& options);

struct WorstTrial {
  std::size_t trial = 0;  // index in the results
  std::string why;
};
/// At most `count` trials with one reason each: first failures, then contacts, then flights that did not
/// land, then those that landed but did not go as planned (figure `completed`), each with how it ended; then
/// the lowest primary figures relative to the mean of the trials in the same cave.
std::vector<WorstTrial> worst_trials(const CampaignResults& results, int metric, std::size_t count);

/// Flights to be shown side by side: for each cave all contestants' flights with the seed that has the worst
/// mean of the primary figure, and with the median seed. Their maps hold at most `max_points` cells in total.
nlohmann::ordered_json report_replays(const CampaignResults& results, int metric, std::size_t max_points,
                                      std::vector<std::string>& notes);

/// The URL of `target` from a page in `folder`: relative, and percent-encoded where needed.
std::string relative_url(const std::filesystem::path& target, const std::filesystem::path& folder);

}  // namespace karst::campaign
