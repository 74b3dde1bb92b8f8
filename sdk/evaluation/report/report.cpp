#include "sdk/evaluation/report/report.h"

#include <fstream>
#include <utility>

#include "core_stack/common/json_file.h"
#include "core_stack/common/json_text.h"
#include "sdk/evaluation/metrics/metrics.h"
#include "sdk/evaluation/page/page.h"
#include "sdk/evaluation/record/whole_file.h"
#include "sdk/evaluation/report/report_assets.h"
#include "sdk/evaluation/report/team_report.h"

namespace karst::evaluation {
namespace {

using nlohmann::ordered_json;
using Texts = std::vector<std::string_view>;

Texts operator+(Texts first, const Texts& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

ordered_json drawings_data(const ReportDrawings& drawings) {
  ordered_json pages = ordered_json::array();
  for (const ReportDrawing& d : drawings.pages) pages.push_back({{"title", d.title}, {"svg", d.svg}});
  return {{"pages", std::move(pages)}, {"note", drawings.note}};
}

}  // namespace

std::string report_page(const ordered_json& data) {
  return assemble_page({.markup = report_template(),
                        .styles = {page_style()},
                        .libraries = three_library() + chart_library(),
                        .scripts = page_scripts() + report_scripts()},
                       data);
}

std::string team_report_page(const ordered_json& data) {
  return assemble_page({.markup = report_template(),
                        .styles = {page_style()},
                        .libraries = three_library() + chart_library(),
                        .scripts = page_scripts() + team_report_scripts()},
                       data);
}

void write_report(const std::filesystem::path& run_dir, const ReportDrawings& drawings) {
  const RunRecord run = read_run(run_dir);
  auto metrics = core::json_of_file<ordered_json>(run_dir / "metrics.json");
  if (!metrics.is_object()) metrics = evaluate_run(run_dir, {});
  ordered_json data = report_data(run, metrics);
  data["cave_drawings"] = drawings_data(drawings);
  write_whole_file(run_dir / "report.html", report_page(data));
}

}  // namespace karst::evaluation
