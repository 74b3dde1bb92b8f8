// Many short flights, each with one fault: docs/fault_campaign.md.
//
//   fault_campaign --out runs/faults --trials 1000        flies what is missing, then prints the summary
//   fault_campaign --out runs/faults --only 17            flies one again and keeps its run directory
//   fault_campaign --out runs/faults --trials 0           prints the summary
#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <mutex>
#include <set>
#include <thread>

#include "core_stack/common/error.h"
#include "sdk/evaluation/record/whole_file.h"
#include "tests/robustness/fly_trial.h"
#include "tests/robustness/tables.h"
#include "tests/robustness/trial_cave.h"

namespace karst::robustness {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  fs::path out;
  std::string binary_dir = KARST_BINARY_DIR, build = "unnamed";
  std::string shared = KARST_SOURCE_DIR "/../shared/data/caves/develop";
  int trials = 1000, only = -1;
  std::size_t jobs = 1;
  double limit_s = 900, hours = 1e6;
};

/// Flies a trial in `folder`, which stays if it is to be looked at.
TrialLine fly_in(const fs::path& folder, const Trial& trial, const Arguments& args) {
  fs::remove_all(folder);
  fs::create_directories(folder);
  const Programs programs{fs::path(args.binary_dir) / "bin/karst",
                          fs::path(args.binary_dir) / "tests/robustness/breaks_later.so"};
  const fs::path cave = folder / "cave.info", run = folder / "run";
  host::ProcessEnd end;
  Verdict verdict;
  try {
    write_trial_cave(trial, programs.karst, args.out / "caves", cave);
    const auto command = command_of(trial, programs, cave, args.out / "cache", run);
    std::ofstream note(folder / "command.txt");
    for (const std::string& word : command) note << '\'' << word << "' ";
    note << '\n';
    end = fly_trial(trial, command, run, folder / "output.txt", args.limit_s);
    verdict = judge(run, end);
  } catch (const core::InputError& e) {
    verdict.reason = e.what();
  }
  return line_of(trial, verdict, end, args.build);
}

/// Appends results, and says how far it is.
class Log {
 public:
  Log(const fs::path& file, std::size_t trials) : file_(file, std::ios::app), left_(trials) {}
  void add(const TrialLine& line, std::size_t jobs) {
    const std::scoped_lock lock(mutex_);
    file_ << to_json(line) + "\n" << std::flush;
    --left_;
    sum_s_ += line.wall_s, ++flown_;
    const double remaining_h =
        sum_s_ / flown_ * static_cast<double>(left_) / static_cast<double>(jobs) / 3600;
    std::fprintf(stderr, "%4d %-10s %-12s %-14s %-40s %4.0f s; %zu left, %.1f h\n", line.trial,
                 name_of(line.verdict.outcome), line.cave.c_str(), line.fault.c_str(),
                 line.fault_text.c_str(), line.wall_s, left_, remaining_h);
  }
  bool good() const { return file_.good(); }

 private:
  std::ofstream file_;
  std::mutex mutex_;
  std::size_t left_;
  double sum_s_ = 0;
  int flown_ = 0;
};

void fly_all(const std::vector<Trial>& trials, const Arguments& args) {
  Log log(args.out / "trials.jsonl", trials.size());
  std::atomic<std::size_t> next{0};
  const auto begin = std::chrono::steady_clock::now();
  const auto time_left = [&] {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    return spent.count() < 3600 * args.hours;
  };
  const auto work = [&] {
    while (log.good() && time_left()) {
      const std::size_t i = next++;
      if (i >= trials.size()) return;
      const fs::path folder = args.out / "bad" / ("trial-" + std::to_string(trials[i].number));
      const TrialLine line = fly_in(folder, trials[i], args);
      log.add(line, args.jobs);
      if (!is_bad(line.verdict.outcome) && args.only < 0) fs::remove_all(folder);
    }
  };
  std::vector<std::thread> workers;
  for (std::size_t i = 0; i < args.jobs; ++i) workers.emplace_back(work);
  for (std::thread& w : workers) w.join();
}

int run(const Arguments& args) {
  fs::create_directories(args.out / "bad");
  setpriority(PRIO_PROCESS, 0, 10);
  std::set<int> flown;
  for (const TrialLine& line : read_trials(args.out / "trials.jsonl")) flown.insert(line.trial);
  const std::vector<CaveChoice> caves = cave_choices(args.shared);
  std::vector<Trial> trials;
  if (args.only >= 0) trials.push_back(draw_trial(args.only, caves));
  for (int i = 0; args.only < 0 && i < args.trials; ++i)
    if (!flown.count(i)) trials.push_back(draw_trial(i, caves));
  fly_all(trials, args);

  const std::vector<TrialLine> all = read_trials(args.out / "trials.jsonl");
  evaluation::write_whole_file(args.out / "clearance.svg", clearance_plot(all));
  evaluation::write_whole_file(args.out / "summary.md", summary(all));
  std::printf("%s", summary(all).c_str());
  const auto bad = [](const TrialLine& l) { return is_bad(l.verdict.outcome); };
  return std::any_of(all.begin(), all.end(), bad) ? 2 : 0;
}

}  // namespace
}  // namespace karst::robustness

int main(int argc, char** argv) {
  karst::robustness::Arguments args;
  CLI::App app{"Flies short missions with one fault each; resumes where it was. Exit code 2: a bad outcome."};
  app.add_option("--out", args.out, "folder of the campaign")->required();
  app.add_option("--trials", args.trials, "numbers 0 to this are flown");
  app.add_option("--only", args.only, "fly this one, again if need be, and keep its run directory");
  app.add_option("--jobs", args.jobs, "trials at once")->check(CLI::Range(1, 256));
  app.add_option("--hours", args.hours, "begin no trial after so long");
  app.add_option("--limit", args.limit_s, "seconds of the wall clock a trial may take");
  app.add_option("--build", args.build, "what flies, noted with each trial: a commit");
  app.add_option("--binaries", args.binary_dir, "build folder");
  app.add_option("--shared", args.shared, "folder of more caves; left out if it is not there");
  CLI11_PARSE(app, argc, argv);
  try {
    return karst::robustness::run(args);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "fault_campaign: %s\n", e.what());
    return 1;
  }
}
