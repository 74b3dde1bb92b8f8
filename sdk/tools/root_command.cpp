#include "sdk/tools/root_command.h"

#include <CLI/CLI.hpp>
#include <sstream>
#include <string>

namespace karst::tools {
namespace {

/// Lists commands by the first line of their description: the rest is the help of each.
class ListingFormatter : public CLI::Formatter {
 public:
  std::string make_subcommand(const CLI::App* command) const override {
    const std::string description = command->get_description();
    std::ostringstream out;
    CLI::detail::format_help(out, command->get_display_name(true),
                             description.substr(0, description.find('\n')), column_width_);
    return out.str();
  }
};

}  // namespace

std::shared_ptr<CLI::App> root_command() {
  auto app = std::make_shared<CLI::App>(
      "karst: fly exploration policies through caves.\n\n"
      "  karst cave generate --preset small --seed 7 --out caves/demo   make a cave\n"
      "  karst preflight caves/demo.info --battery \"8 min\"             say go or no-go before a mission\n"
      "  karst fly --cave caves/demo.info --policy nearest_frontier     fly a policy through it\n"
      "  karst compare CAMPAIGN.info                                    say which of several policies is "
      "better\n"
      "  karst policy list                                              see what can be flown\n"
      "  karst policy new NAME                                          begin a policy of your own\n"
      "  karst replay scans --out runs/replayed                         localize and map from recorded "
      "scans\n"
      "  karst evaluate runs/demo                                       errors of trajectory and map\n"
      "  karst map merge runs/a runs/b --out maps/both                  maps of several flights in one",
      "karst");
  app->formatter(std::make_shared<ListingFormatter>());
  app->set_version_flag("--version", KARST_VERSION);
  app->require_subcommand(1);
  return app;
}

void add_help_of_all(CLI::App& app) {
  app.set_help_all_flag("--help-all", "Print the help of every command and exit");
}

}  // namespace karst::tools
