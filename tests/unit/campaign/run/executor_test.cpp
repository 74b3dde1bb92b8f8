#include "sdk/campaign/run/executor.h"

#include <gtest/gtest.h>
#include <sys/mount.h>
#include <unistd.h>

#include <csignal>
#include <cstring>

#include "sdk/campaign/run/collect.h"
#include "tests/unit/campaign/store/store_fixture.h"

namespace karst::campaign {
namespace {

using host::ProcessOutput;
using host::run_process;

/// A trial that runs a line of shell; $2 is its run directory.
TrialJob job(const fs::path& dir, const std::string& name, const std::string& script) {
  return {{"/bin/sh", "-c", script, "trial"}, dir / "trials" / name, "identity of " + name};
}

ExecutorOptions options_for(const fs::path& dir, double timeout_s = 100) {
  return {2, timeout_s, dir / "flying", {}, nullptr};
}

std::vector<ProcessEnd> ends_of(const std::vector<TrialJob>& jobs, const ExecutorOptions& options) {
  std::vector<ProcessEnd> ends(jobs.size());
  std::size_t ended = 0;
  EXPECT_TRUE(
      run_trials(jobs, options, {[&](std::size_t i, const ProcessEnd& e) { ends[i] = e, ++ended; }, {}}));
  EXPECT_EQ(ended, jobs.size());
  return ends;
}

TEST(Executor, EveryEndOfATrialIsAResult) {
  const fs::path dir = fresh_folder("ends");
  const auto ends =
      ends_of({job(dir, "fine", "echo said; echo 1 > $2/metrics.json"), job(dir, "three", "exit 3"),
               job(dir, "crash", "kill -SEGV $$"), job(dir, "killed", "kill -KILL $$"),
               TrialJob{{"/nowhere/karst"}, dir / "trials" / "missing", ""}},
              options_for(dir));
  EXPECT_EQ(ends[0].exit_code, 0);
  EXPECT_EQ(ends[1].exit_code, 3);
  EXPECT_EQ(ends[2].signal, SIGSEGV);
  EXPECT_EQ(ends[3].signal, SIGKILL);
  EXPECT_EQ(ends[4].exit_code, 127);
  EXPECT_TRUE(fs::exists(dir / "trials" / "fine" / "metrics.json"));
  const TrialNote note = read_note(dir / "trials" / "crash");
  EXPECT_EQ(note.end.signal, SIGSEGV);
  EXPECT_EQ(note.identity, "identity of crash");
  EXPECT_TRUE(says(describe(ends[2]), "signal 11"));
  EXPECT_TRUE(fs::is_empty(dir / "flying"));
}

TEST(Executor, AHangingTrialIsEndedWithAllItStarted) {
  const fs::path dir = fresh_folder("hang");
  const auto ends =
      ends_of({job(dir, "hang", "sleep 1000 & echo $! > $2/pid; trap '' TERM INT; wait; sleep 1000")},
              options_for(dir, 1.5));
  EXPECT_TRUE(ends[0].hung);
  pid_t grandchild = 0;
  std::ifstream(dir / "trials" / "hang" / "pid") >> grandchild;
  ASSERT_GT(grandchild, 0);
  for (int i = 0; i < 500 && kill(grandchild, 0) == 0; ++i) {  // until init, or who reaps, has noticed
    std::ifstream stat("/proc/" + std::to_string(grandchild) + "/stat");
    std::string pid, name, state;
    if (!(stat >> pid >> name >> state) || state == "Z") break;
    usleep(10000);
  }
  std::ifstream stat("/proc/" + std::to_string(grandchild) + "/stat");
  std::string pid, name, state;
  EXPECT_TRUE(!(stat >> pid >> name >> state) || state == "Z") << "still there, in state " << state;
}

TEST(Executor, NeverFliesMoreThanAskedForAndTakesThemInOrder) {
  const fs::path dir = fresh_folder("order");
  std::vector<TrialJob> jobs;
  for (int i = 0; i < 7; ++i)
    jobs.push_back(
        job(dir, std::to_string(i), "ls " + (dir / "flying").string() + " | wc -l > $2/seen; sleep 0.05"));
  std::size_t most = 0;
  ASSERT_TRUE(
      run_trials(jobs, options_for(dir), {{}, [&](std::size_t flying) { most = std::max(most, flying); }}));
  EXPECT_LE(most, 2u);
  for (int i = 0; i < 7; ++i) {
    int seen = 0;
    std::ifstream(dir / "trials" / std::to_string(i) / "seen") >> seen;
    EXPECT_GE(seen, 1);
    EXPECT_LE(seen, 2);
  }
}

TEST(Executor, StoppedItLeavesOnlyWholeTrials) {
  const fs::path dir = fresh_folder("stopped");
  std::atomic<bool> stop{false};
  ExecutorOptions options = options_for(dir);
  options.stop = &stop;
  const std::vector<TrialJob> jobs = {job(dir, "quick", "true"), job(dir, "slow", "sleep 1000"),
                                      job(dir, "next", "sleep 1000")};
  EXPECT_FALSE(run_trials(jobs, options, {[&](std::size_t, const ProcessEnd&) { stop = true; }, {}}));
  EXPECT_TRUE(fs::exists(dir / "trials" / "quick" / "trial.json"));
  EXPECT_FALSE(fs::exists(dir / "trials" / "slow"));
  EXPECT_TRUE(fs::is_empty(dir / "flying"));
}

TEST(Executor, WhatAnEarlierAttemptLeftIsReplaced) {
  const fs::path dir = fresh_folder("replaced");
  fs::create_directories(dir / "trials" / "a");
  std::ofstream(dir / "trials" / "a" / "old") << "old";
  ends_of({job(dir, "a", "echo new > $2/new")}, options_for(dir));
  EXPECT_TRUE(fs::exists(dir / "trials" / "a" / "new"));
  EXPECT_FALSE(fs::exists(dir / "trials" / "a" / "old"));
}

TEST(Executor, ATrialThatAnotherMachineHasFlownMeanwhileStays) {
  const fs::path dir = fresh_folder("meanwhile");
  const fs::path there = dir / "trials" / "a";
  const std::string note = R"({"exit_code": 0, "signal": 0, "hung": false, "wall_s": 1, "machine": "other",)"
                           R"( "identity": "identity of a"})";
  ends_of({job(dir, "a",
               "mkdir -p " + there.string() + "; echo '" + note + "' > " + there.string() + "/trial.json")},
          options_for(dir));
  EXPECT_EQ(read_note(there).machine, "other");
  EXPECT_TRUE(fs::is_empty(dir / "flying"));
}

TEST(Executor, ATrialThatFindsNoRoomIsNoResult) {
  const fs::path dir = fresh_folder("no_room");
  const std::string e = error_of([&] {
    ends_of({job(dir, "a", "echo 'karst: cannot be written: No space left on device'; exit 2")},
            options_for(dir));
  });
  EXPECT_TRUE(says(e, "the disk is full")) << e;
  EXPECT_FALSE(fs::exists(dir / "trials" / "a"));
}

TEST(Executor, OnAFullDiskNothingFlies) {
  const fs::path dir = fresh_folder("full_disk"), disk = dir / "disk";
  fs::create_directories(disk);
  if (mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=1m") != 0)
    GTEST_SKIP() << "skipped: mounting a small tmpfs takes root: " << std::strerror(errno);
  const std::string e = error_of([&] { ends_of({job(disk, "a", "true")}, options_for(disk)); });
  umount2(disk.c_str(), MNT_DETACH);
  EXPECT_TRUE(says(e, "the disk is full")) << e;
}

TEST(Process, ItsOutputAndItsEndAreTold) {
  const ProcessOutput out = run_process({"/bin/sh", "-c", "echo out; echo err >&2; exit 4"}, 100);
  EXPECT_EQ(out.end.exit_code, 4);
  EXPECT_EQ(out.out, "out\nerr\n");
  EXPECT_TRUE(run_process({"/bin/sleep", "1000"}, 0.2).end.hung);
}

// Rows of trials that did not go well.

Plan one_trial_plan() {
  Plan plan;
  plan.trial_timeout_s = 60;
  plan.contestants.resize(1);
  plan.contestants[0].name = "near";
  plan.contestants[0].binary_version = "0.1.0+x";
  plan.caves.resize(1);
  plan.caves[0].name = "maze";
  plan.seeds = {4};
  return plan;
}

StoredTrial collected(const std::string& name, const std::string& script, double timeout_s = 100) {
  const fs::path dir = fresh_folder(name);
  TrialJob j = job(dir, "unused", script);
  j.run_dir = dir / run_dir_of(one_trial_plan(), {0, 0, 4});
  ends_of({j}, options_for(dir, timeout_s));
  return collect(one_trial_plan(), {0, 0, 4}, dir);
}

TEST(Collect, ATrialThatCouldNotStartIsFailedWithItsOwnReason) {
  const StoredTrial t = collected("c_start", "echo 'karst: a.info: motion.max_speed: bad' >&2; exit 1");
  EXPECT_TRUE(t.result.failed);
  EXPECT_EQ(t.result.outcome, "failed");
  EXPECT_EQ(t.result.reason, "a.info: motion.max_speed: bad");
  EXPECT_EQ(t.result.run_dir, "trials/near/maze/4");
  for (const double v : t.result.figures) EXPECT_TRUE(std::isnan(v));
}

TEST(Collect, ACrashNamesTheSignalAndKeepsWhatTheRecordTells) {
  const StoredTrial t =
      collected("c_crash",
                "printf 't_s,phase,explored_m3\\n0.1,explore,10\\n5,explore,40\\n' > $2/telemetry.csv;"
                "echo '{\"coverage\": 0.25}' > $2/metrics.json; echo last words; kill -SEGV $$");
  EXPECT_TRUE(t.result.failed);
  EXPECT_TRUE(says(t.result.reason, "killed by signal 11")) << t.result.reason;
  EXPECT_TRUE(says(t.result.reason, "last words"));
  EXPECT_EQ(t.result.figures[static_cast<std::size_t>(evaluation::metric_index("coverage"))], 0.25);
  ASSERT_EQ(t.result.curve.size(), 4u);  // every 2 s, and the last
  EXPECT_EQ(t.result.curve[0].explored_m3, 10);
  EXPECT_EQ(t.result.curve[3].explored_m3, 40);
  EXPECT_NEAR(t.result.curve[3].time_s, 4.9, 1e-9);
  EXPECT_EQ(t.result.curve[3].coverage, 0.25);
}

TEST(Collect, AHungTrialNamesItsTimeoutAndNotTheMomentItWasSeen) {
  EXPECT_EQ(collected("c_hung", "sleep 1000", 0.2).result.reason, "hung: not done after 60 s");
}

TEST(Collect, AFlightThatDidNotLandIsDone) {
  const StoredTrial t = collected(
      "c_done",
      "echo '{\"outcome\": \"contact\", \"reason\": \"rock\", \"contacts\": 1}' > $2/metrics.json; exit 2");
  EXPECT_FALSE(t.result.failed);
  EXPECT_EQ(t.result.outcome, "contact");
  EXPECT_EQ(t.result.reason, "rock");
  EXPECT_EQ(t.result.figures[static_cast<std::size_t>(evaluation::metric_index("contacts"))], 1);
}

/// Leaves the record of a flight that the supervisor sent home.
const std::string kSentHome = R"(
printf '%s\n' '{"t": 1, "kind": "phase", "phase": "takeoff"}' '{"t": 4, "kind": "phase", "phase": "explore"}' \
  '{"t": 5, "kind": "safety", "action": "home", "reason": "no sensor sees the cave any more"}' \
  '{"t": 5, "kind": "phase", "phase": "home", "reason": "no sensor sees the cave any more"}' \
  '{"t": 7, "kind": "outcome", "outcome": "landed", "reason": "at the start"}' > $2/events.jsonl
echo '{"outcome": "landed", "reason": "at the start", "completed": 0, "battery_left": 0.98}' > $2/metrics.json
)";

TEST(Collect, TellsHowAFlightEndedThatCameHomeEarly) {
  const TrialResult r = collected("c_early", kSentHome + "exit 2").result;
  EXPECT_FALSE(r.failed) << r.reason;
  EXPECT_EQ(r.outcome, "landed");
  EXPECT_EQ(r.reason, "at the start");
  EXPECT_EQ(r.ended, "home after 4 s: no sensor saw the cave any more; 98 % battery left");
  EXPECT_EQ(r.figures[static_cast<std::size_t>(evaluation::metric_index("completed"))], 0);
}

// How far a record goes that a signal cut off may depend on the machine's load.
TEST(Collect, OfAFailedTrialTellsTheReasonAlone) {
  const TrialResult r = collected("c_failed", kSentHome + "kill -SEGV $$").result;
  EXPECT_TRUE(r.failed);
  EXPECT_EQ(r.ended, "");
}

TEST(Collect, OneThatLeftNoFiguresIsFailedWhateverItsExitCode) {
  EXPECT_TRUE(collected("c_none", "exit 0").result.failed);
  EXPECT_TRUE(collected("c_bad", "echo '{' > $2/metrics.json").result.failed);
}

}  // namespace
}  // namespace karst::campaign
