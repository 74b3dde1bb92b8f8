// The campaign's report.html, as `karst compare` and `karst report` write it.
#pragma once
#include <filesystem>
#include <string>

namespace karst::campaign {

/// Writes report.html beside the store of a campaign, given by its folder or its store, and gives its path.
/// `metric` is the figure its verdict is about; "": the one that was declared. With `mission_reports` the
/// worst trials get theirs, too.
std::filesystem::path write_campaign_page(const std::filesystem::path& folder_or_store,
                                          const std::string& metric, bool mission_reports = false);

/// Whether a campaign's store lies there, or is it.
bool is_campaign(const std::filesystem::path& folder_or_store);

}  // namespace karst::campaign
