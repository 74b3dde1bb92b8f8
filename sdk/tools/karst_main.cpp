#include "sdk/tools/root_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "core_stack/common/options.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/karst_command.h"

namespace karst::tools {
namespace {

/// The command to which the words lead as far as they are valid.
const CLI::App& reached(const CLI::App& app) {
  const CLI::App* at = &app;
  // An option group is a subcommand without a name.
  while (!at->get_subcommands().empty() && !at->get_subcommands().front()->get_name().empty())
    at = at->get_subcommands().front();
  return *at;
}

/// True of `karst` and of a group such as `karst policy` with nothing behind them.
bool is_bare_group(const CLI::App& app) {
  const CLI::App& at = reached(app);
  return at.get_require_subcommand_min() > 0 && at.remaining().empty();
}

/// The first word that names no command where one was expected; "" if all words so far are valid.
std::string wrong_command(const CLI::App& app) {
  const CLI::App& at = reached(app);
  const std::vector<std::string> rest = at.remaining();
  if (at.get_require_subcommand_min() == 0 || rest.empty()) return "";
  std::vector<std::string> names;
  for (const CLI::App* command : at.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  const std::string near = core::nearest_name(rest.front(), names);
  return "\"" + rest.front() + "\" is no command" +
         (near.empty() ? "; --help lists them" : "; did you mean " + near + "?");
}

/// The first word that is an option of no command; "" if there is none.
std::string wrong_option(const CLI::App& app) {
  const CLI::App& at = reached(app);
  const std::vector<std::string> rest = at.remaining();
  const auto wrong =
      std::find_if(rest.begin(), rest.end(), [](const std::string& word) { return word.starts_with("--"); });
  if (wrong == rest.end()) return "";
  std::vector<std::string> names;
  for (const CLI::Option* option : at.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  const std::string given = wrong->substr(0, wrong->find('='));
  const std::string near = core::nearest_name(given, names);
  return "\"" + given + "\" is no option of " + at.get_name() +
         (near.empty() ? "; --help lists them" : "; did you mean " + near + "?");
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
  std::string wrong = wrong_command(app);
  if (wrong.empty()) wrong = wrong_option(app);
  if (wrong.empty()) {
    app.exit(e);
  } else {
    print_error("karst: %s\n", wrong.c_str());
  }
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
