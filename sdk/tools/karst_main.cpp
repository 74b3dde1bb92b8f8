#include "sdk/tools/root_command.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "sdk/terminal/terminal.h"
#include "sdk/tools/karst_command.h"
#include "sdk/tools/usage_error.h"

namespace karst::tools {
namespace {

/// True of `karst` and of a group such as `karst policy` with nothing behind them.
bool is_bare_group(const CLI::App& app) {
  const CLI::App& at = reached(app);
  return at.get_require_subcommand_min() > 0 && at.remaining().empty();
}

/// The help of a command, to which `words` lead, and of all below it.
void print_help_of_all(const CLI::App& app, const std::string& words) {
  std::fputs(app.get_formatter()->make_help(&app, words, CLI::AppFormatMode::Normal).c_str(), stdout);
  for (const CLI::App* below :
       app.get_subcommands([](const CLI::App* a) { return !a->get_group().empty(); })) {
    std::fputs("\n", stdout);
    print_help_of_all(*below, words + " " + below->get_name());
  }
}

/// CLI11's own codes above 100 are useless to scripts: a usage error gets the code of any other error.
int exit_code(const CLI::App& app, const CLI::ParseError& e) {
  if (e.get_name() == "RuntimeError") return e.get_exit_code();
  if (e.get_name() == "CallForAllHelp") {
    print_help_of_all(app, app.get_name());
    return 0;
  }
  if (e.get_name() == "RequiredError" && is_bare_group(app)) {
    std::fputs(app.help().c_str(), stdout);
    return 0;
  }
  if (e.get_exit_code() == 0) return app.exit(e);
  print_error("%s", usage_error(app, e).c_str());
  return 1;
}

}  // namespace

int karst_main(int argc, char** argv) {
  std::shared_ptr<CLI::App> app;
  int code = 0;
  try {
    app = karst_command();
    app->parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    code = exit_code(*app, e);
  } catch (const std::exception& e) {
    print_wrapped(stderr, 7, "karst: %s\n", e.what());
    code = 1;
  }
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  print_error("karst: standard output cannot be written\n");
  return code == 0 ? 1 : code;
}

}  // namespace karst::tools
