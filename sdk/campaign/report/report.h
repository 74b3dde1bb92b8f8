// The page of a campaign in one file: verdicts, curves, pairs, tables, and replays side by side.
// docs/report.md
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "sdk/campaign/store/results.h"
#include "sdk/campaign/verdict/verdict.h"

namespace karst::campaign {

struct CampaignReportOptions {
  VerdictOptions verdict;
  std::size_t replay_points =
      2000000;                   // map cells of all flights replayed together, about 6 bytes each; 0: none
  std::size_t worst = 12;        // trials listed as the worst
  bool mission_reports = false;  // write the missing reports of these trials
};

/// All data shown on the page, as one JSON object. Links are relative to `folder`, the folder of the page.
nlohmann::ordered_json campaign_report_data(const CampaignResults& results,
                                            const std::filesystem::path& folder,
                                            const CampaignReportOptions& options = {});

/// The complete page with scripts, styles and data; it loads no other files.
std::string campaign_report_page(const nlohmann::ordered_json& data);

/// Writes the campaign's page to `file`, also for a running campaign or one with hardly any results. A run
/// directory that is missing or damaged only loses its replay. Throws InputError if the file cannot be
/// written.
void write_campaign_report(const std::filesystem::path& file, const CampaignResults& results,
                           const CampaignReportOptions& options = {});

}  // namespace karst::campaign
