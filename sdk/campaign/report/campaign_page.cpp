#include "sdk/campaign/report/campaign_page.h"

#include "sdk/campaign/report/report.h"
#include "sdk/campaign/store/store.h"

namespace karst::campaign {

namespace fs = std::filesystem;

fs::path write_campaign_page(const fs::path& folder_or_store, const std::string& metric,
                             bool mission_reports) {
  CampaignReportOptions options;
  options.mission_reports = mission_reports;
  const CampaignResults results = read_results(folder_or_store);
  options.verdict.metric = metric.empty() ? results.metric : metric;
  const fs::path page = store_file(folder_or_store).parent_path() / "report.html";
  write_campaign_report(page, results, options);
  return page;
}

bool is_campaign(const fs::path& folder_or_store) {
  const fs::path store = store_file(folder_or_store);
  return fs::is_regular_file(store) && !fs::exists(folder_or_store / "mission.info");
}

}  // namespace karst::campaign
