#include "sdk/campaign/report/report.h"

#include "sdk/campaign/report/report_assets.h"
#include "sdk/campaign/report/report_parts.h"
#include "sdk/evaluation/page/page.h"
#include "sdk/evaluation/record/whole_file.h"
#include "sdk/evaluation/report/report.h"
#include "sdk/evaluation/report/report_assets.h"

namespace karst::campaign {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

std::string campaign_report_page(const ordered_json& data) {
  std::vector<std::string_view> scripts = evaluation::page_scripts();
  for (const std::string_view own : campaign_scripts()) scripts.push_back(own);
  return evaluation::assemble_page({.markup = campaign_template(),
                                    .styles = {evaluation::page_style(), campaign_style(), plot_style()},
                                    .libraries = evaluation::three_library(),
                                    .scripts = std::move(scripts)},
                                   data);
}

void write_campaign_report(const fs::path& file, const CampaignResults& results,
                           const CampaignReportOptions& options) {
  const fs::path folder = fs::absolute(file).parent_path();
  evaluation::write_whole_file(file, campaign_report_page(campaign_report_data(results, folder, options)));
}

}  // namespace karst::campaign
