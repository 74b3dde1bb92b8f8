// The `karst` command.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "core_stack/common/options.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/cave_command.h"
#include "sdk/tools/compare_command.h"
#include "sdk/tools/evaluate_command.h"
#include "sdk/tools/explain_command.h"
#include "sdk/tools/explain_time_command.h"
#include "sdk/tools/fly_command.h"
#include "sdk/tools/map_command.h"
#include "sdk/tools/policy_command.h"
#include "sdk/tools/replay_command.h"
#include "sdk/tools/report_command.h"
#include "sdk/tools/select_command.h"
#include "sdk/tools/table_command.h"
#include "sdk/tools/tune_command.h"

namespace {

/// The first word that names no command where one was expected; "" if all words so far are valid.
std::string wrong_command(const CLI::App& app) {
  const CLI::App* at = &app;
  while (!at->get_subcommands().empty()) at = at->get_subcommands().front();
  const std::vector<std::string> rest = at->remaining();
  if (at->get_require_subcommand_min() == 0 || rest.empty()) return "";
  std::vector<std::string> names;
  for (const CLI::App* command : at->get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  const std::string near = karst::core::nearest_name(rest.front(), names);
  return "\"" + rest.front() + "\" is no command" + (near.empty() ? "" : "; did you mean " + near + "?");
}

/// CLI11's own codes above 100 are useless to scripts: a usage error gets the code of any other error.
int exit_code(const CLI::App& app, const CLI::ParseError& e) {
  if (e.get_name() == "RuntimeError") return e.get_exit_code();
  const std::string wrong = e.get_exit_code() == 0 ? "" : wrong_command(app);
  if (!wrong.empty()) karst::print_error("karst: %s\n", wrong.c_str());
  return app.exit(e) == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "karst: fly exploration policies through caves.\n\n"
      "  karst cave generate --preset small --seed 7 --out caves/demo   make a cave\n"
      "  karst fly --cave caves/demo.info --policy nearest_frontier     fly a policy through it\n"
      "  karst compare CAMPAIGN.info                                    say which of several policies is "
      "better\n"
      "  karst policy list                                              see what can be flown\n"
      "  karst policy new NAME                                          begin a policy of your own\n"
      "  karst replay scans --out runs/replayed                         localize and map from recorded "
      "scans\n"
      "  karst evaluate runs/demo                                       errors of trajectory and map\n"
      "  karst map merge runs/a runs/b --out maps/both                  maps of several flights in one",
      "karst"};
  app.set_version_flag("--version", KARST_VERSION);
  app.require_subcommand(1);
  karst::tools::add_fly_command(app);
  karst::tools::add_compare_command(app);
  karst::tools::add_trials_command(app);
  karst::tools::add_results_command(app);
  karst::tools::add_policy_command(app);
  karst::tools::add_cave_command(app);
  karst::tools::add_report_command(app);
  karst::tools::add_table_command(app);
  karst::tools::add_explain_command(app);
  karst::tools::add_explain_time_command(app);
  karst::tools::add_replay_command(app);
  karst::tools::add_evaluate_command(app);
  karst::tools::add_map_command(app);
  karst::tools::add_select_command(app);
  karst::tools::add_tune_command(app);
  int code = 0;
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    code = exit_code(app, e);
  } catch (const std::exception& e) {
    karst::print_error("karst: %s\n", e.what());
    code = 1;
  }
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  karst::print_error("karst: standard output cannot be written\n");
  return code == 0 ? 1 : code;
}
