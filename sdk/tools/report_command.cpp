#include "sdk/tools/report_command.h"

#include <CLI/CLI.hpp>
#include <boost/property_tree/ptree.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "core_stack/common/error.h"
#include "core_stack/common/json_file.h"
#include "core_stack/common/options.h"
#include "sdk/evaluation/team/team_folders.h"
#include "sdk/flight/finish_run.h"
#include "sdk/flight/team_metrics.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/help/value_types.h"

namespace karst::tools {
namespace {

namespace fs = std::filesystem;

const char* file_of(flight::Report report) {
  return report == flight::Report::written ? "report.html" : "metrics.json";
}

/// For a flight that was killed: it wrote no metrics.json.
nlohmann::ordered_json metrics_of_cut_team(const fs::path& run, const std::string& cave,
                                           const std::vector<nlohmann::json>& robots) {
  const auto info = core::read_info((run / "mission.info").string());
  return flight::begin_team_metrics({info.get("policy.name", ""), cave, info.get("seed", std::int64_t{0}),
                                     core::MissionOutcome::aborted, "the record ends without an outcome"},
                                    robots);
}

/// Evaluates each robot and the team again. Values known only to the mission itself are kept as written.
void report_team(const fs::path& run, const flight::Finishing& how) {
  const char* written = file_of(how.report);
  std::vector<nlohmann::json> own;
  for (const fs::path& robot : evaluation::robot_folders(run)) {
    own.push_back(flight::finish_run(robot, how));
    print_out("%s\n", (robot / written).c_str());
  }
  auto metrics = core::json_of_file<nlohmann::ordered_json>(run / "metrics.json");
  if (!metrics.is_object()) {
    print_error("karst: %s: not there or no JSON object: outcomes of the team are not known\n",
                (run / "metrics.json").c_str());
    metrics = metrics_of_cut_team(run, how.cave, own);
  }
  flight::add_sums(metrics, own);
  flight::finish_team(run, how, metrics);
  print_out("%s\n", (run / written).c_str());
}

}  // namespace

void add_report_command(CLI::App& app, CampaignPage campaign_page) {
  struct Arguments {
    std::string run, metric;
    bool no_report = false, worst = false;
  };
  auto args = std::make_shared<Arguments>();
  CLI::App* report = app.add_subcommand(
      "report",
      "Write the report of a run, or of a campaign\n\n"
      "Evaluates a run directory again and rewrites its metrics.json and report.html, also for a run that "
      "was cut short. The report of a campaign can be written while it flies.\n\n"
      "  karst report runs/demo\n  karst report runs/CAMPAIGN --worst");
  report->add_option("run", args->run, "run directory, or a campaign's folder or store")
      ->type_name(kFile)
      ->required();
  report->add_flag("--no-report", args->no_report, "of a run: metrics only, no report.html");
  report
      ->add_option("--metric", args->metric,
                   "of a campaign: the figure that its verdict is about; default: as it declared")
      ->type_name(kMetric);
  report->add_flag("--worst", args->worst,
                   "of a campaign: write the mission reports of its worst trials, too");
  report->callback([args, page_of = std::move(campaign_page)] {
    const fs::path run = args->run;
    if (const std::optional<fs::path> page = page_of(run, args->metric, args->worst)) {
      print_out("%s\n", page->c_str());
      return;
    }
    if (!fs::exists(run / "mission.info") && !fs::exists(run / "events.jsonl"))
      throw core::InputError(args->run, "",
                             "no run directory, as it holds no mission.info, nor a campaign's folder");
    const flight::Finishing how =
        flight::recorded_finishing(run, args->no_report ? flight::Report::none : flight::Report::written);
    if (evaluation::is_team(run)) {
      report_team(run, how);
      return;
    }
    flight::finish_run(run, how);
    print_out("%s\n", (run / file_of(how.report)).c_str());
  });
}

}  // namespace karst::tools
