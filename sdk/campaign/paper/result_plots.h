// The figures of a campaign for a paper, as SVG, from the data of the campaign's page
// (sdk/campaign/report/report_parts.h).
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "sdk/campaign/store/results.h"
#include "sdk/campaign/verdict/verdict.h"

namespace karst::campaign {

/// Coverage over time, over all caves: each contestant's mean and its interval. `curves` is the data of
/// report_curves(), not null.
std::string coverage_plot(const CampaignResults& results, const nlohmann::ordered_json& curves);

/// A row for each pair of contestants: the difference in the primary figure and its interval. Filled marks:
/// a difference is shown. `verdicts` is the data of report_verdicts().
std::string differences_plot(const CampaignResults& results, const nlohmann::ordered_json& verdicts);

/// A row for each cave: every contestant's mean in a figure and its interval. `summary` is the data of
/// report_summary() in this figure.
std::string caves_plot(const CampaignResults& results, const nlohmann::ordered_json& summary, int metric);

}  // namespace karst::campaign
