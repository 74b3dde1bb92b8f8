#include "sdk/tools/explain_time_command.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core_stack/common/error.h"
#include "sdk/evaluation/metrics/lost_time.h"
#include "sdk/evaluation/metrics/speed_limit_times.h"
#include "sdk/evaluation/team/team_folders.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/help/value_types.h"

namespace karst::tools {
namespace {

namespace fs = std::filesystem;
using evaluation::LostTime;
using evaluation::Slowdown;
using evaluation::SlowdownCause;
using evaluation::SpeedLimitTimes;

struct Row {
  std::string name;
  double at_s = 0, before_s = 0, after_s = 0;
  double total_s() const { return at_s + before_s + after_s; }
};

std::vector<Row> rows_of(const LostTime& lost) {
  std::vector<Row> rows;
  for (const auto& [cause, name] : names_of(SlowdownCause{})) {
    const Slowdown& s = lost[cause];
    rows.push_back({name, s.at_s, s.before_s, s.after_s});
  }
  rows.push_back({"looking around at the start", lost.look_around_s, 0, 0});
  rows.push_back({"turning on the spot", lost.turning_s, 0, 0});
  rows.push_back({"waiting at rest", lost.waiting_s, 0, 0});
  rows.push_back({"nearly full speed", lost.nearly_full_speed_s, 0, 0});
  return rows;
}

void print(const std::string& run, const LostTime& lost) {
  print_out("%s: explored for %.1f s, %.1f m, %.2f m/s as a mean\n", run.c_str(), lost.explored_s,
            lost.path_m, lost.path_m / lost.explored_s);
  print_out("Of that, %.1f s were lost against %.2f m/s throughout:\n", lost.total_s, lost.max_speed_mps);
  print_out("  %-28s %9s %9s %9s %9s\n", "s", "lost", "at it", "braking", "after it");
  for (const Row& row : rows_of(lost))
    print_out("  %-28s %9.1f %9.1f %9.1f %9.1f\n", row.name.c_str(), row.total_s(), row.at_s, row.before_s,
              row.after_s);
}

/// Why it flew as fast as it did. Missions up to 2 m/s do not record it.
void print(const SpeedLimitTimes& times) {
  if (times.total_s() <= 0) return;
  print_out("What set its speed, braking for it included:\n");
  for (const auto& [limit, name] : names_of(core::SpeedLimit{}))
    if (times[limit].time_s > 0)
      print_out("  %-44s %7.1f s %6.2f m/s\n", evaluation::words_for(limit), times[limit].time_s,
                times[limit].path_m / times[limit].time_s);
}

void explain(const std::vector<std::string>& runs, double until_s) {
  for (const std::string& run : runs) {
    std::vector<fs::path> folders{run};
    if (evaluation::is_team(run)) folders = evaluation::robot_folders(run);
    for (const fs::path& folder : folders) {
      const evaluation::RunRecord record = evaluation::read_run(folder);
      const auto lost = evaluation::lost_time(record, until_s);
      if (!lost || lost->explored_s <= 0)
        throw core::InputError(
            folder.string(), "",
            "no telemetry of a flight that explored, or no limits of motion in mission.info");
      print(folder.string(), *lost);
      print(evaluation::speed_limit_times(record, until_s));
    }
  }
}

}  // namespace

void add_explain_time_command(CLI::App& app) {
  struct Arguments {
    std::vector<std::string> runs;
    double until_s = std::numeric_limits<double>::infinity();
  };
  CLI::App& command = *app.add_subcommand(
      "explain-time",
      "Say what a flight lost time for while it explored\n\n"
      "Prints the seconds lost against full speed by cause: bends, the heading rate, stops, with the braking "
      "before them and the speeding up after them.\n\n"
      "  karst explain-time runs/demo\n"
      "  karst explain-time runs/* --until 120");
  auto arguments = std::make_shared<Arguments>();
  command.add_option("RUN", arguments->runs, "run directories, as `karst fly --out` writes them")
      ->type_name(kFolder)
      ->required();
  command.add_option("--until", arguments->until_s, "seconds of the run's time; later ones do not count")
      ->check(CLI::PositiveNumber);
  command.callback([arguments] { explain(arguments->runs, arguments->until_s); });
}

}  // namespace karst::tools
