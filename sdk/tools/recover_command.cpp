#include "sdk/tools/recover_command.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "core_stack/common/error.h"
#include "sdk/flight/finish_run.h"
#include "sdk/flight/recover_run.h"
#include "sdk/terminal/terminal.h"
#include "sdk/tools/help/value_types.h"

namespace karst::tools {

void add_recover_command(CLI::App& app) {
  struct Arguments {
    std::string run;
    bool no_report = false;
  };
  auto args = std::make_shared<Arguments>();
  CLI::App* recover = app.add_subcommand(
      "recover",
      "Make map, metrics and report of a flight that was cut off\n\n"
      "After a power cut or a kill. Writes map.bt, map.ot and map.ply of what the flight kept, then "
      "metrics.json "
      "and report.html, and says what is missing. Changes no file that the flight wrote.\n\n"
      "  karst recover runs/demo");
  recover->add_option("run", args->run, "run directory")->type_name(kFolder)->required();
  recover->add_flag("--no-report", args->no_report, "no report.html");
  recover->callback([args] {
    namespace fs = std::filesystem;
    const fs::path run = args->run;
    if (!fs::is_directory(run)) throw core::InputError(args->run, "", "is not a directory");
    if (flight::is_whole(run)) {
      print_out("%s: the flight is whole, and nothing was changed; karst report writes its report anew\n",
                run.c_str());
      return;
    }
    const flight::RecoveredMap map = flight::recover_map(run);
    for (const std::string& note : map.notes) print_wrapped(stderr, 7, "karst: %s\n", note.c_str());
    for (const fs::path& file : map.written) print_out("%s\n", file.c_str());
    const flight::Report report = args->no_report ? flight::Report::none : flight::Report::written;
    flight::finish_run(run, flight::recorded_finishing(run, report));
    print_out("%s\n", (run / "metrics.json").c_str());
    if (report == flight::Report::written) print_out("%s\n", (run / "report.html").c_str());
  });
}

}  // namespace karst::tools
