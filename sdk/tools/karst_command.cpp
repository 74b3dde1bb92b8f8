#include "sdk/tools/karst_command.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "sdk/campaign/report/campaign_page.h"
#include "sdk/flight/auto_policy.h"
#include "sdk/tools/cave_command.h"
#include "sdk/tools/cave_describe_command.h"
#include "sdk/tools/check_command.h"
#include "sdk/tools/compare_command.h"
#include "sdk/tools/draw_command.h"
#include "sdk/tools/evaluate_command.h"
#include "sdk/tools/explain_command.h"
#include "sdk/tools/explain_time_command.h"
#include "sdk/tools/export_command.h"
#include "sdk/tools/fly_command.h"
#include "sdk/tools/from_cloud_command.h"
#include "sdk/tools/from_survey_command.h"
#include "sdk/tools/help_commands.h"
#include "sdk/tools/live_flight_option.h"
#include "sdk/tools/map_command.h"
#include "sdk/tools/policy_command.h"
#include "sdk/tools/preflight_command.h"
#include "sdk/tools/python_command.h"
#include "sdk/tools/recording_command.h"
#include "sdk/tools/recover_command.h"
#include "sdk/tools/replay_command.h"
#include "sdk/tools/report_command.h"
#include "sdk/tools/request_replay_command.h"
#include "sdk/tools/root_command.h"
#include "sdk/tools/select_command.h"
#include "sdk/tools/table_command.h"
#include "sdk/tools/tune_command.h"
#include "sdk/tools/vehicle_command.h"

namespace karst::tools {
namespace {

/// The page of a campaign; nothing of a run directory.
std::optional<std::filesystem::path> campaign_page(const std::filesystem::path& run,
                                                   const std::string& metric, bool with_worst_trials) {
  if (!campaign::is_campaign(run)) return std::nullopt;
  return campaign::write_campaign_page(run, metric, with_worst_trials);
}

}  // namespace

std::shared_ptr<CLI::App> karst_command() {
  const std::shared_ptr<CLI::App> app = root_command();
  add_preflight_command(*app);
  add_fly_command(*app, flight::choose_policy, serve_live);
  add_compare_command(*app);
  add_trials_command(*app);
  add_results_command(*app);
  CLI::App& policy = add_policy_command(*app);
  add_check_command(policy);
  add_request_replay_command(policy);
  CLI::App& cave = add_cave_command(*app);
  add_cave_describe(cave);
  add_from_cloud_command(cave);
  add_from_survey_command(cave);
  add_report_command(*app, campaign_page);
  add_recover_command(*app);
  add_draw_command(*app);
  add_table_command(*app);
  add_explain_command(*app);
  add_explain_time_command(*app);
  add_recording_command(*app);
  add_replay_command(*app);
  add_evaluate_command(*app);
  add_map_command(*app);
  add_export_command(*app);
  add_select_command(*app);
  add_tune_command(*app);
  add_vehicle_command(*app);
  add_python_command(*app);
  add_help_commands(*app);
  add_help_of_all(*app);
  return app;
}

}  // namespace karst::tools
