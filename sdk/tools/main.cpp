// The `karst` command.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "core_stack/common/error.h"
#include "sdk/tools/cave_command.h"
#include "sdk/tools/fly_command.h"
#include "sdk/tools/policy_command.h"
#include "sdk/tools/report_command.h"
#include "sdk/tools/table_command.h"

int main(int argc, char** argv) {
  CLI::App app{
      "karst: fly exploration policies through caves.\n\n"
      "  karst cave generate --preset small --seed 7 --out caves/demo   make a cave\n"
      "  karst fly --cave caves/demo.info --policy nearest_frontier     fly a policy through it\n"
      "  karst policy list                                              see what can be flown",
      "karst"};
  app.set_version_flag("--version", KARST_VERSION);
  app.require_subcommand(1);
  karst::tools::add_fly_command(app);
  karst::tools::add_policy_command(app);
  karst::tools::add_cave_command(app);
  karst::tools::add_report_command(app);
  karst::tools::add_table_command(app);
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& e) {
    return app.exit(e);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "karst: %s\n", e.what());
    return 1;
  }
}
