#include "sdk/tools/campaign_page.h"

#include "sdk/campaign/report.h"
#include "sdk/campaign/store.h"

namespace karst::tools {

namespace fs = std::filesystem;

fs::path write_campaign_page(const fs::path& folder_or_store, const std::string& metric,
                             bool mission_reports) {
  campaign::CampaignReportOptions options;
  options.mission_reports = mission_reports;
  const campaign::CampaignResults results = campaign::read_results(folder_or_store);
  options.verdict.metric = metric.empty() ? results.metric : metric;
  const fs::path page = campaign::store_file(folder_or_store).parent_path() / "report.html";
  campaign::write_campaign_report(page, results, options);
  return page;
}

bool is_campaign(const fs::path& folder_or_store) {
  const fs::path store = campaign::store_file(folder_or_store);
  return fs::is_regular_file(store) && !fs::exists(folder_or_store / "mission.info");
}

}  // namespace karst::tools
