#include "sdk/campaign/run/executor.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <sstream>
#include <thread>

#include "core_stack/common/error.h"
#include "core_stack/common/input_file.h"
#include "core_stack/common/json_text.h"
#include "sdk/evaluation/record/whole_file.h"

namespace karst::campaign {
namespace {

namespace fs = std::filesystem;
using core::InputError;
using host::end_process;
using host::start_process;
using Clock = std::chrono::steady_clock;

constexpr std::uintmax_t kMinSpace = 64u << 20;  // free to begin a trial; a trial writes tens of megabytes
constexpr const char* kNoteFile = "trial.json";

std::string machine_name() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

struct Flying {
  std::size_t job;
  pid_t pid;
  fs::path folder;
  Clock::time_point begin;
  double wall_s() const { return std::chrono::duration<double>(Clock::now() - begin).count(); }
};

void refuse_full_disk(const fs::path& folder) {
  std::error_code error;
  const fs::space_info space = fs::space(folder, error);
  if (!error && space.available < kMinSpace)
    throw InputError(
        folder.string(), "",
        "the disk is full: less than 64 MB are free; make room and start the campaign again, it goes on "
        "where it was");
}

/// A trial that failed for lack of disk space says nothing about its policy.
void refuse_starved(const fs::path& folder) {
  std::string said;
  if (fs::exists(folder / kLogFile)) said = core::read_input(folder / kLogFile, core::kMaxRecordFileBytes);
  if (said.find(std::strerror(ENOSPC)) != std::string::npos) {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
    throw InputError(
        folder.string(), "",
        "the disk is full: the trial could not be recorded; make room and start the campaign again, it "
        "goes on where it was");
  }
  refuse_full_disk(folder);
}

Flying start(const TrialJob& job, std::size_t index, const ExecutorOptions& options) {
  refuse_full_disk(options.flying);
  // In containers, two machines may have the same name and two processes the same number.
  const fs::path folder =
      options.flying / (machine_name() + "-" + std::to_string(getpid()) + "-" + std::to_string(index) + "-" +
                        std::to_string(std::random_device{}()));
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder.string(), "", "cannot be made: " + error.message());
  std::vector<std::string> argv = job.command;
  argv.insert(argv.end(), {"--out", folder.string()});
  const auto begin = Clock::now();
  return {index, start_process(argv, folder / kLogFile), folder, begin};
}

/// Renames the folder of a finished trial to its final name.
void finish_trial(const Flying& f, const TrialJob& job, const ProcessEnd& end,
                  const ExecutorOptions& options) {
  if (end.exit_code != 0 || end.signal != 0) refuse_starved(f.folder);
  if (options.finish) options.finish(f.folder);
  std::error_code error;
  write_note(f.folder, {end, machine_name(), job.identity});
  fs::create_directories(job.run_dir.parent_path(), error);
  fs::rename(f.folder, job.run_dir, error);  // fails if there is a flight already
  if (!error) return;
  if (!is_flown(job)) {  // but one of another build
    fs::remove_all(job.run_dir, error);
    fs::rename(f.folder, job.run_dir, error);
    if (!error) return;
    if (!is_flown(job)) throw InputError(job.run_dir.string(), "", "cannot be made: " + error.message());
  }
  fs::remove_all(f.folder, error);  // a task that was taken for lost has flown it meanwhile
}

/// How a trial ended, or none if it still runs.
std::optional<ProcessEnd> end_of(const Flying& f, double timeout_s) {
  ProcessEnd end;
  if (!has_ended(f.pid, end)) {
    if (f.wall_s() < timeout_s) return std::nullopt;
    end_process(f.pid);
    end.hung = true;
  }
  end.wall_s = f.wall_s();
  return end;
}

/// Ends all running trials on destruction, so that none is left behind.
class InTheAir {
 public:
  std::vector<Flying> trials;
  InTheAir() = default;
  InTheAir(const InTheAir&) = delete;
  InTheAir& operator=(const InTheAir&) = delete;
  ~InTheAir() {
    std::error_code ignored;
    for (const Flying& f : trials) {
      end_process(f.pid);
      fs::remove_all(f.folder, ignored);
    }
  }
};

}  // namespace

bool run_trials(const std::vector<TrialJob>& jobs, const ExecutorOptions& options,
                const ExecutorEvents& events) {
  std::error_code error;
  fs::create_directories(options.flying, error);
  if (error) throw InputError(options.flying.string(), "", "cannot be made: " + error.message());
  InTheAir air;
  std::size_t next = 0;
  for (auto last_tick = Clock::now();;) {
    if (options.stop && *options.stop) return next == jobs.size() && air.trials.empty();
    while (air.trials.size() < options.jobs && next < jobs.size()) {
      air.trials.push_back(start(jobs[next], next, options));
      ++next;
    }
    if (air.trials.empty()) return true;
    for (std::size_t i = 0; i < air.trials.size();) {
      const std::optional<ProcessEnd> end = end_of(air.trials[i], options.timeout_s);
      if (!end) {
        ++i;
        continue;
      }
      const Flying f = air.trials[i];
      air.trials.erase(air.trials.begin() + static_cast<std::ptrdiff_t>(i));
      finish_trial(f, jobs[f.job], *end, options);
      if (events.ended) events.ended(f.job, *end);
    }
    if (events.tick && Clock::now() - last_tick > std::chrono::milliseconds(100)) {
      events.tick(air.trials.size());
      last_tick = Clock::now();
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

void write_note(const fs::path& run_dir, const TrialNote& note) {
  const nlohmann::ordered_json json{{"schema", "karst.trial/1"}, {"exit_code", note.end.exit_code},
                                    {"signal", note.end.signal}, {"hung", note.end.hung},
                                    {"wall_s", note.end.wall_s}, {"machine", note.machine},
                                    {"identity", note.identity}};
  evaluation::write_whole_file(run_dir / kNoteFile, core::json_text(json, 2) + "\n");
}

TrialNote read_note(const fs::path& run_dir) {
  const fs::path file = run_dir / kNoteFile;
  const auto json = core::json_of(core::read_input(file, core::kMaxTextFileBytes));
  try {
    return {{json.at("exit_code"), json.at("signal"), json.at("hung"), json.at("wall_s")},
            json.at("machine"),
            json.at("identity")};
  } catch (const nlohmann::json::exception&) {
    throw InputError(file.string(), "", "is no note of a trial");
  }
}

bool is_flown(const TrialJob& job) {
  try {
    return read_note(job.run_dir).identity == job.identity;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace karst::campaign
