// The commands of a karst that only flies (KARST_FLIGHT_ONLY): what `make demo` builds in half the time.
// Those it lacks are listed, and say how to get them.
#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include "core_stack/common/error.h"
#include "sdk/flight/auto_policy.h"
#include "sdk/tools/cave_command.h"
#include "sdk/tools/explain_command.h"
#include "sdk/tools/explain_time_command.h"
#include "sdk/tools/fly_command.h"
#include "sdk/tools/karst_command.h"
#include "sdk/tools/policy_command.h"
#include "sdk/tools/recover_command.h"
#include "sdk/tools/report_command.h"
#include "sdk/tools/root_command.h"
#include "sdk/tools/table_command.h"

namespace karst::tools {
namespace {

constexpr const char* kHowToGetIt = "is not in this build, which only flies; `make build` adds it";

void refuse_auto(flight::Mission& mission) {
  if (mission.policy == flight::kAutoPolicy)
    throw core::InputError(mission.file, "policy.name", std::string("policy auto ") + kHowToGetIt);
}

std::shared_ptr<core::RecordListener> refuse_live(const flight::Mission&, const flight::FlightRequest&,
                                                  const LiveArguments&) {
  throw core::InputError("karst fly", "--live", kHowToGetIt);
}

std::optional<std::filesystem::path> refuse_campaign(const std::filesystem::path& run, const std::string&,
                                                     bool) {
  if (!std::filesystem::exists(run / "mission.info"))
    throw core::InputError(
        run.string(), "",
        std::string("no run directory, as it holds no mission.info; the report of a campaign ") +
            kHowToGetIt);
  return std::nullopt;
}

/// A command that is not there: it takes whatever follows.
void add_missing(CLI::App& group, const char* name) {
  CLI::App* missing = group.add_subcommand(name, "(`make build` adds it)");
  missing->prefix_command();
  missing->callback([words = "`karst " + (group.get_parent() == nullptr ? "" : group.get_name() + " ") +
                             name + "` "] { throw std::runtime_error(words + kHowToGetIt); });
}

}  // namespace

std::shared_ptr<CLI::App> karst_command() {
  const std::shared_ptr<CLI::App> app = root_command();
  add_fly_command(*app, refuse_auto, refuse_live);
  CLI::App& policy = add_policy_command(*app);
  CLI::App& cave = add_cave_command(*app);
  add_report_command(*app, refuse_campaign);
  add_recover_command(*app);
  add_table_command(*app);
  add_explain_command(*app);
  add_explain_time_command(*app);
  for (const char* name : {"preflight", "compare", "results", "recording", "replay", "evaluate", "draw",
                           "map", "export", "select", "tune", "vehicle", "python", "completion"})
    add_missing(*app, name);
  for (const char* name : {"check", "replay"}) add_missing(policy, name);
  for (const char* name : {"describe", "from-cloud", "from-survey"}) add_missing(cave, name);
  add_help_of_all(*app);
  return app;
}

}  // namespace karst::tools
