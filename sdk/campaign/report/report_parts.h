// The parts of the campaign page's data (docs/report.md).
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sdk/campaign/store/results.h"
#include "sdk/campaign/verdict/verdict.h"

namespace karst::campaign {

/// A number of six significant digits, or null if it is not known.
nlohmann::ordered_json number_or_null(double v);

/// Of the mean of `values` by cave: over seeds, or over caves where a cave has too few. It is cut at what the
/// figure can be, where the widening for few seeds leads beyond: the truth cannot lie there.
struct MeanInterval {
  evaluation::Interval interval;
  bool over_caves = false;
};
MeanInterval mean_interval(const evaluation::Differences& values, const VerdictOptions& options,
                           int resamples, const evaluation::Interval& possible);

/// Verdicts, ranking, and every pair of contestants in every figure.
nlohmann::ordered_json report_verdicts(const Verdicts& verdicts);

/// What each contestant's trials show alone: [figure][contestant] -> {all, caves}, each with n, mean and
/// interval or null. Caves weigh the same.
nlohmann::ordered_json report_summaries(const CampaignResults& results, const VerdictOptions& options);

/// Coverage and explored volume over time on one grid of times: every trial's, and means with intervals by
/// contestant, of each cave and over all.
nlohmann::ordered_json report_curves(const CampaignResults& results, const VerdictOptions& options);

struct WorstTrial {
  std::size_t trial = 0;  // index in the results
  std::string why;
};
/// At most `count`, one reason each: failed, then contact, then ends short of landing, then the least of the
/// primary figure against the mean of the trials in its cave.
std::vector<WorstTrial> worst_trials(const CampaignResults& results, int metric, std::size_t count);

/// Flights to be shown side by side: of each cave all contestants' with the seed that went worst in the mean
/// of the primary figure, and with the middle one. Their maps hold at most `max_points` cells together.
nlohmann::ordered_json report_replays(const CampaignResults& results, int metric, std::size_t max_points,
                                      std::vector<std::string>& notes);

/// Where a page in `folder` finds `target`, as a URL: relative, and percent-encoded where it must be.
std::string relative_url(const std::filesystem::path& target, const std::filesystem::path& folder);

}  // namespace karst::campaign
