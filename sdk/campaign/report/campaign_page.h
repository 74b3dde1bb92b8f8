// The campaign's report.html, as `karst compare` and `karst report` write it.
#pragma once
#include <filesystem>
#include <string>

namespace karst::campaign {

/// Writes report.html beside the store of a campaign, given by its folder or its store, and returns its path.
/// `metric` is the figure that decides the verdict; "": the declared one. With `mission_reports` the worst
/// trials get reports of their own, too.
std::filesystem::path write_campaign_page(const std::filesystem::path& folder_or_store,
                                          const std::string& metric, bool mission_reports = false);

/// Whether the path is a campaign's store, or a folder that contains one.
bool is_campaign(const std::filesystem::path& folder_or_store);

}  // namespace karst::campaign
