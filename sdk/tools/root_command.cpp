#include "sdk/tools/root_command.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "sdk/terminal/terminal.h"
#include "sdk/tools/help/help_formatter.h"
#include "sdk/tools/usage_error.h"

namespace karst::tools {
namespace {

/// Null if there is none of that name.
const CLI::App* command_below(const CLI::App& app, const std::string& name) {
  const std::vector<const CLI::App*> named =
      app.get_subcommands([&](const CLI::App* below) { return below->get_name() == name; });
  return named.empty() ? nullptr : named.front();
}

/// `karst help fly` prints what `karst fly --help` does. Hidden: the help names --help.
void add_help_as_command(CLI::App& app) {
  CLI::App* help = app.add_subcommand("help", "Print the help of a command")->group("");
  help->prefix_command();
  help->callback([&app, help] {
    const CLI::App* at = &app;
    std::string words = app.get_name();
    for (const std::string& word : help->remaining()) {
      if (word.starts_with('-')) continue;  // such as --help once more
      const CLI::App* below = command_below(*at, word);
      if (below == nullptr) throw std::runtime_error(unknown_command(*at, word));
      at = below;
      words += " " + word;
    }
    std::fputs(app.get_formatter()->make_help(at, words, CLI::AppFormatMode::Normal).c_str(), stdout);
  });
}

}  // namespace

std::shared_ptr<CLI::App> root_command() {
  auto app = std::make_shared<CLI::App>(
      "karst: fly exploration policies through caves.\n\n"
      "  karst cave generate --preset small --seed 7 --out caves/demo   make a cave\n"
      "  karst cave from-survey cave.svx --out caves/real               make a cave of a survey\n"
      "  karst preflight caves/demo.info --battery \"8 min\"              say go or no-go before a mission\n"
      "  karst fly --cave caves/demo.info --policy nearest_frontier     fly a policy through it\n"
      "  karst compare CAMPAIGN.info                                    say which of several policies is "
      "better\n"
      "  karst policy list                                              see what can be flown\n"
      "  karst policy new NAME                                          begin a policy of your own\n"
      "  karst replay scans --out runs/replayed                         localize and map from recorded "
      "scans\n"
      "  karst evaluate runs/demo                                       errors of trajectory and map\n"
      "  karst export runs/demo --survey surveys/demo                   make a survey of a flight\n"
      "  karst map merge runs/a runs/b --out maps/both                  maps of several flights in one",
      "karst");
  app->formatter(std::make_shared<HelpFormatter>(help_columns()));
  app->set_help_flag("-h,--help", "print this help and exit");
  app->set_version_flag("--version", KARST_VERSION, "print the version and exit");
  app->require_subcommand(1);
  add_help_as_command(*app);
  return app;
}

void add_help_of_all(CLI::App& app) {
  app.set_help_all_flag("--help-all", "print the help of every command and exit");
}

}  // namespace karst::tools
