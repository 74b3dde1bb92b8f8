#include "sdk/survey/cavern.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <sstream>
#include <string_view>
#include <system_error>
#include <thread>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "core_stack/common/printable.h"
#include "core_stack/common/program_in_path.h"
#include "sdk/host/isolation/process.h"

namespace karst::survey {
namespace {

namespace fs = std::filesystem;

constexpr double kProgramLimit_s = 300;
constexpr std::uintmax_t kMaxPrinted = 4096 * core::kMiB;  // by dump3d: about 100 bytes a station or leg
constexpr std::uintmax_t kMaxSaid = 16 * core::kMiB;       // by cavern

/// Runs a program of Survex on a file to its end, in English. `log` takes what it prints.
host::ProcessEnd run_program(const std::string& name, std::vector<std::string> arguments,
                             const std::string& file, const fs::path& log, std::uintmax_t max_bytes,
                             const std::string& shown_as) {
  core::check_input(file, kMaxPrinted);
  const auto program = core::program_in_path(name);
  if (!program)
    throw core::InputError(shown_as, "",
                           name + " of Survex is not installed, or not in PATH: apt-get install survex");
  std::vector<std::string> argv = {"/usr/bin/env", "LC_ALL=C", "SURVEXLANG=en", *program};
  arguments.push_back(file.starts_with('-') ? "./" + file : file);  // else the name would be an option
  argv.insert(argv.end(), arguments.begin(), arguments.end());
  const pid_t pid = host::start_process(argv, log);
  const auto began = std::chrono::steady_clock::now();
  host::ProcessEnd end;
  const auto check_printed = [&] {
    std::error_code none;
    if (fs::file_size(log, none) > max_bytes && !none)
      throw core::InputError(shown_as, "", name + " prints without end");
  };
  try {
    while (!host::has_ended(pid, end)) {
      const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - began;
      if (waited.count() > kProgramLimit_s)
        throw core::InputError(shown_as, "", name + " is not done after five minutes");
      check_printed();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  } catch (const core::InputError&) {
    host::end_process(pid);
    throw;
  }
  check_printed();
  return end;
}

/// "FILE:LINE:COLUMN: error: TEXT", where line and column may lack, or the program's name stands for the
/// file.
std::optional<CavernMessage> message_of(std::string_view line) {
  CavernMessage message;
  for (const std::string_view kind : {": error: ", ": warning: "}) {
    const std::size_t at = line.find(kind);
    if (at == std::string_view::npos) continue;
    message.error = kind == ": error: ";
    message.text = core::printable(line.substr(at + kind.size()));
    std::string_view where = line.substr(0, at);
    for (int numbers = 0; numbers < 2; ++numbers) {
      const std::size_t colon = where.rfind(':');
      if (colon == std::string_view::npos) break;
      std::size_t number = 0;
      const auto [end, failed] =
          std::from_chars(where.data() + colon + 1, where.data() + where.size(), number);
      if (failed != std::errc() || end != where.data() + where.size()) break;
      message.line = number;  // the line stands before the column
      where = where.substr(0, colon);
    }
    message.file = where;
    if (message.line == 0) message.file.clear();
    return message;
  }
  return std::nullopt;
}

void add_once(const std::string& name, std::vector<std::string>& names) {
  if (names.size() < 1000 && std::find(names.begin(), names.end(), name) == names.end())
    names.push_back(name);
}

}  // namespace

bool has_survex() { return core::program_in_path("cavern") && core::program_in_path("dump3d"); }

std::vector<CavernMessage> cavern_messages(const std::string& output) {
  std::vector<CavernMessage> messages;
  bool names_follow = false;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    if (auto message = message_of(line)) {
      messages.push_back(std::move(*message));
      names_follow = false;
    }
    // The names of unattached stations follow on lines of their own, some twice.
    else if (messages.empty() || !messages.back().error || messages.back().line != 0 || line.empty())
      continue;
    else if (names_follow)
      add_once(core::printable(line), messages.back().unattached);
    else if (line.find("not attached") != std::string::npos)
      names_follow = true;
    else if (messages.back().text.size() < 200)
      messages.back().text += "; " + core::printable(line);
  }
  return messages;
}

CavernRun run_cavern(const std::string& file, const fs::path& folder, const std::string& shown_as) {
  const std::string& shown = shown_as.empty() ? file : shown_as;
  const fs::path log = folder / "cavern.txt";
  const host::ProcessEnd end =
      run_program("cavern", {"--quiet", "--quiet", "--output=" + (folder / "closed").string()}, file, log,
                  kMaxSaid, shown);
  CavernRun run;
  run.messages = cavern_messages(core::read_input(log.string(), kMaxSaid));
  run.three_d = folder / "closed.3d";
  run.err = folder / "closed.err";
  run.closed = end.exit_code == 0 && end.signal == 0 && fs::exists(run.three_d);
  if (end.signal != 0) throw core::InputError(shown, "", "cavern was " + host::describe(end));
  return run;
}

fs::path run_dump3d(const std::string& file, const fs::path& folder, const std::string& shown_as) {
  const std::string& shown = shown_as.empty() ? file : shown_as;
  const fs::path printed = folder / "dump3d.txt";
  const host::ProcessEnd end = run_program("dump3d", {}, file, printed, kMaxPrinted, shown);
  if (end.exit_code != 0 || end.signal != 0) {
    std::ifstream said = core::open_input(printed.string(), kMaxPrinted);
    std::string line, last;
    while (std::getline(said, line))
      if (!line.empty()) last = line.substr(0, 500);
    throw core::InputError(shown, "", "cannot be read as a survey: " + core::printable(last));
  }
  return printed;
}

}  // namespace karst::survey
