// `karst report RUN`: evaluates a run directory again and rewrites its metrics.json and report.html, or
// writes the report of a campaign.
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace karst::tools {

/// Writes the page of a campaign and returns its path; nothing if `folder_or_store` is none. `metric` is ""
/// for the declared one.
using CampaignPage = std::function<std::optional<std::filesystem::path>(
    const std::filesystem::path& folder_or_store, const std::string& metric, bool with_worst_trials)>;

void add_report_command(CLI::App& app, CampaignPage campaign_page);

}  // namespace karst::tools
