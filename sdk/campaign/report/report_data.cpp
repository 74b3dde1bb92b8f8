#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <system_error>

#include "core_stack/common/error.h"
#include "core_stack/common/json_text.h"
#include "sdk/campaign/report/report.h"
#include "sdk/campaign/report/report_parts.h"
#include "sdk/cave_drawing/report_drawings.h"
#include "sdk/evaluation/metrics/metric_definitions.h"
#include "sdk/evaluation/report/report.h"
#include "sdk/evaluation/report/team_report.h"
#include "sdk/evaluation/team/team_folders.h"

namespace karst::campaign {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// The path without . and .. and without a slash at its end.
fs::path plain_path(const fs::path& path) {
  const fs::path normal = path.lexically_normal();
  return normal.has_filename() ? normal : normal.parent_path();
}

ordered_json definitions() {
  ordered_json list = ordered_json::array();
  for (const auto& m : evaluation::metric_definitions()) {
    list.push_back(
        {{"name", m.name}, {"unit", m.unit}, {"better", core::name_of(m.better)}, {"meaning", m.meaning}});
  }
  return list;
}

/// Parses JSON text from the store; text that is not JSON becomes a string.
ordered_json parsed(const std::string& text) {
  if (text.empty()) return ordered_json::object();
  ordered_json value = core::json_of<ordered_json>(text);
  return value.is_discarded() ? ordered_json(text) : value;
}

ordered_json contestants(const CampaignResults& results) {
  ordered_json list = ordered_json::array();
  for (const ContestantEntry& c : results.contestants)
    list.push_back({{"name", c.name},
                    {"policy", c.policy},
                    {"version", c.version},
                    {"parameters", parsed(c.parameters)},
                    {"settings", parsed(c.settings)}});
  return list;
}

ordered_json caves(const CampaignResults& results) {
  ordered_json list = ordered_json::array();
  for (const CaveEntry& c : results.caves)
    list.push_back({{"name", c.name}, {"file", c.file}, {"start", c.start}});
  return list;
}

/// The figures as measured; in `counted` the values that statistics use instead, as for a failed trial.
ordered_json trial_row(const CampaignResults& results, const TrialResult& t, const fs::path& folder) {
  ordered_json figures = ordered_json::array(), counted = ordered_json::array();
  for (std::size_t m = 0; m < t.figures.size(); ++m) {
    figures.push_back(number_or_null(t.figures[m]));
    counted.push_back(number_or_null(figure_of(t, static_cast<int>(m), results.horizon_s)));
  }
  ordered_json row = {
      {"contestant", t.contestant}, {"cave", t.cave},     {"seed", t.seed},  {"failed", t.failed},
      {"outcome", t.outcome},       {"reason", t.reason}, {"ended", t.ended}};
  std::error_code no_matter;
  const bool kept = !t.run_dir.empty() && fs::is_directory(t.run_dir, no_matter);
  row["run"] = kept ? ordered_json(relative_url(t.run_dir, folder)) : ordered_json(nullptr);
  row["reported"] = kept && fs::exists(fs::path(t.run_dir) / "report.html", no_matter);
  if (kept) row["path"] = plain_path(t.run_dir).lexically_relative(plain_path(folder)).string();
  if (counted != figures) row["counted"] = std::move(counted);
  row["figures"] = std::move(figures);
  return row;
}

ordered_json worst(const CampaignResults& results, int metric, const CampaignReportOptions& options,
                   std::vector<std::string>& notes) {
  ordered_json list = ordered_json::array();
  for (const WorstTrial& w : worst_trials(results, metric, options.worst)) {
    list.push_back({{"trial", w.trial}, {"why", w.why}});
    const fs::path run = results.trials[w.trial].run_dir;
    std::error_code no_matter;
    if (!options.mission_reports || run.empty() || !fs::is_directory(run, no_matter) ||
        fs::exists(run / "report.html", no_matter))
      continue;
    try {
      if (evaluation::is_team(run))
        evaluation::write_team_report(run);
      else
        evaluation::write_report(run, cave_drawing::report_drawings(run));
    } catch (const std::exception& e) {  // one damaged trial must not affect the others
      notes.push_back(std::string("no mission report: ") + e.what());
    }
  }
  return list;
}

}  // namespace

ordered_json number_or_null(double v) {
  if (!std::isfinite(v)) return nullptr;
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", v);
  const double rounded = std::strtod(text, nullptr);
  if (rounded == std::floor(rounded) && std::abs(rounded) < 1e15) return static_cast<std::int64_t>(rounded);
  return rounded;
}

std::string relative_url(const fs::path& target, const fs::path& folder) {
  constexpr std::string_view plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~/";
  std::string url = "./";  // then no name can be mistaken for a scheme
  for (const char c : plain_path(target).lexically_relative(plain_path(folder)).generic_string()) {
    char coded[4];
    std::snprintf(coded, sizeof coded, "%%%02X", static_cast<unsigned char>(c));
    url += plain.find(c) != std::string_view::npos ? std::string(1, c) : coded;
  }
  return url;
}

ordered_json campaign_report_data(const CampaignResults& results, const fs::path& folder,
                                  const CampaignReportOptions& options) {
  const Verdicts verdicts = compare_all(results, options.verdict);
  std::vector<std::string> notes;
  ordered_json d;
  d["name"] = results.name;
  d["horizon_s"] = number_or_null(results.horizon_s);
  d["alpha"] = options.verdict.alpha;
  d["metrics"] = definitions();
  d["contestants"] = contestants(results);
  d["caves"] = caves(results);
  d["verdicts"] = report_verdicts(verdicts);
  d["summaries"] = report_summaries(results, options.verdict);
  d["curves"] = report_curves(results, options.verdict);
  d["worst"] = worst(results, verdicts.metric, options, notes);  // may write reports that trials link to
  d["trials"] = ordered_json::array();
  for (const TrialResult& t : results.trials) d["trials"].push_back(trial_row(results, t, folder));
  d["replays"] = report_replays(results, verdicts.metric, options.replay_points, notes);
  d["notes"] = notes;
  return d;
}

}  // namespace karst::campaign
