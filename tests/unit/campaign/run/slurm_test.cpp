// What the Slurm executor does with tasks that are lost, with stand-ins for Slurm's commands; against the
// real ones: tests/closed_loop/slurm_test.sh.
#include "sdk/campaign/run/slurm.h"

#include <csignal>
#include <cstdlib>
#include <thread>

#include "sdk/campaign/run/collect.h"
#include "sdk/campaign/run/slurm_batch.h"
#include "sdk/campaign/run/slurm_queue.h"
#include "tests/unit/campaign/store/store_fixture.h"

namespace karst::campaign {
namespace {

void write_program(const fs::path& file, const std::string& script) {
  std::ofstream(file) << "#!/bin/sh\n" << script;
  fs::permissions(file, fs::perms::owner_all);
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// sbatch notes how it was asked, and what `flown/1`, `flown/2` ... hold are the run directories that its
/// first, second ... array brings about; no task ever waits. squeue prints the file `queue`, if it is there.
class StandInSlurm {
 public:
  StandInSlurm(const fs::path& dir, const fs::path& trials) : path_(std::getenv("PATH")) {
    fs::create_directories(dir / "bin");
    fs::create_directories(trials);
    write_program(dir / "bin" / "sbatch", "echo \"$*\" >> " + (dir / "asked").string() + "; n=$(wc -l < " +
                                              (dir / "asked").string() + "); mv " + (dir / "flown").string() +
                                              "/$n/* " + trials.string() + " 2>/dev/null; echo $n\n");
    write_program(dir / "bin" / "squeue", "[ -z \"$SQUEUE_PARTITION\" ] || exit 0; cat " +
                                              (dir / "queue").string() + " 2>/dev/null; : > " +
                                              (dir / "polled").string() + "\n");
    write_program(dir / "bin" / "scancel", "echo \"$*\" >> " + (dir / "cancelled").string() + "\n: > " +
                                               (dir / "queue").string() + "\n");
    setenv("PATH", ((dir / "bin").string() + ":" + path_).c_str(), 1);
  }
  ~StandInSlurm() { setenv("PATH", path_.c_str(), 1); }
  StandInSlurm(const StandInSlurm&) = delete;
  StandInSlurm& operator=(const StandInSlurm&) = delete;

 private:
  std::string path_;
};

Plan plan_of_three() {
  Plan plan;
  plan.trial_timeout_s = 60;
  plan.contestants.resize(1);
  plan.contestants[0].name = "near";
  plan.caves.resize(1);
  plan.caves[0].name = "maze";
  plan.seeds = {1, 2, 3};
  return plan;
}

TEST(Slurm, ATrialThatIsLostTwiceIsAFailedOneAndTakesNoneWithIt) {
  const fs::path dir = fresh_folder("slurm_lost");
  const Plan plan = plan_of_three();
  std::vector<TrialJob> jobs;
  for (const std::int64_t seed : plan.seeds) {
    const std::string name = std::to_string(seed);
    jobs.push_back({{"karst", "fly"}, dir / run_dir_of(plan, {0, 0, seed}), "identity " + name});
  }
  const StandInSlurm slurm(dir, jobs[0].run_dir.parent_path());
  // The first array brings seed 1 about, the second seed 2; seed 3 never comes.
  for (std::size_t i = 0; i < 2; ++i) {
    const fs::path flown = dir / "flown" / std::to_string(i + 1) / std::to_string(i + 1);
    fs::create_directories(flown);
    std::ofstream(flown / "metrics.json") << "{\"outcome\": \"landed\", \"coverage\": 0.5}";
    write_note(flown, {{0, 0, false, 1}, "node", jobs[i].identity});
  }
  std::ofstream(dir / "queue") << "1|0|OUT_OF_MEMORY|0|0|node1|None|\n2|0|COMPLETED|0|0|node1|None|\n"
                                  "2|1|OUT_OF_MEMORY|0|0|node1|None|\n";
  SlurmOptions options;
  options.folder = dir;
  options.karst = "/bin/karst";
  options.name = "lost";
  options.batch = 3;
  options.look_s = 0.05;
  std::vector<std::size_t> ended;
  std::vector<ProcessEnd> ends(3);
  ASSERT_TRUE(run_on_slurm(jobs, options,
                           {[&](std::size_t i, const ProcessEnd& e) {
                              ended.push_back(i);
                              ends[i] = e;
                            },
                            {}}));
  EXPECT_EQ(ended, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(ends[0].signal, 0);
  EXPECT_EQ(ends[1].signal, 0);
  EXPECT_EQ(ends[2].signal, SIGKILL);
  // One array of one task for all; then one of a task for each that was lost, and no third.
  const std::string asked = text_of(dir / "asked");
  EXPECT_EQ(std::count(asked.begin(), asked.end(), '\n'), 2) << asked;
  EXPECT_TRUE(says(asked, "--array=0-0 ")) << asked;
  EXPECT_TRUE(says(asked, "--array=0-1 ")) << asked;
  EXPECT_FALSE(fs::exists(dir / "slurm" / "array"));  // nothing is left to be cancelled

  const StoredTrial kept = collect(plan, {0, 0, 2}, dir), lost = collect(plan, {0, 0, 3}, dir);
  EXPECT_FALSE(kept.result.failed) << kept.result.reason;
  EXPECT_TRUE(lost.result.failed);
  EXPECT_TRUE(says(lost.result.reason, "its Slurm task ended without it, 2 times")) << lost.result.reason;
  EXPECT_TRUE(is_flown(jobs[2]));  // a resumed campaign does not fly it a third time
}

/// Waits for what another thread brings about, but not for ever.
template <class Condition>
void wait_until(Condition condition) {
  for (int i = 0; i < 4000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

/// A campaign of three trials, one a task, on a stand-in whose squeue prints these lines.
class OnStandIn {
 public:
  OnStandIn(const std::string& name, const std::string& queue)
      : dir(fresh_folder(name)), slurm_(dir, dir / "trials" / "near" / "maze") {
    const Plan plan = plan_of_three();
    for (const std::int64_t seed : plan.seeds)
      jobs.push_back(
          {{"karst", "fly"}, dir / run_dir_of(plan, {0, 0, seed}), "identity " + std::to_string(seed)});
    std::ofstream(dir / "queue") << queue;
    options.folder = dir;
    options.karst = "/bin/karst";
    options.name = "lost";
    options.batch = 1;
    options.look_s = 0.05;
  }
  void fly_trial(std::size_t i) const {
    fs::create_directories(dir / "part");
    std::ofstream(dir / "part" / "metrics.json") << "{\"outcome\": \"landed\", \"coverage\": 0.5}";
    write_note(dir / "part", {{0, 0, false, 1}, "node", jobs[i].identity});
    fs::create_directories(jobs[i].run_dir.parent_path());
    fs::rename(dir / "part", jobs[i].run_dir);
  }
  bool run() {
    return run_on_slurm(jobs, options,
                        {{}, {}, [this](const std::string& text) { said += text + "\n"; }, {}});
  }
  fs::path dir;
  std::vector<TrialJob> jobs;
  SlurmOptions options;
  std::string said;

 private:
  StandInSlurm slurm_;
};

TEST(Slurm, TasksThatCannotFlyStopTheCampaignAndAreNoResults) {
  OnStandIn s("slurm_no_karst",
              "1|0|FAILED|32512|0|node7|NonZeroExitCode|\n2|0|FAILED|32512|0|node8|NonZeroExitCode|\n");
  s.jobs.resize(1);
  // What the second task printed is in its output, by the time it is over.
  std::thread task([&] {
    const fs::path log = s.dir / "slurm" / "batches" / "2" / "0.txt";
    wait_until([&] { return fs::exists(log.parent_path() / "task.sh"); });
    std::ofstream(log) << "task.sh: /bin/karst: not found\n";
  });
  const std::string e = error_of([&] { s.run(); });
  task.join();
  EXPECT_TRUE(says(e, "task 2_0")) << e;
  EXPECT_TRUE(says(e, "FAILED with exit code 127 on node8")) << e;
  EXPECT_TRUE(says(e, "it said last: task.sh: /bin/karst: not found")) << e;
  EXPECT_TRUE(says(s.said, "task 1_0 ended without 1 trial (FAILED with exit code 127 on node7)")) << s.said;
  EXPECT_FALSE(fs::exists(s.jobs[0].run_dir));
}

TEST(Slurm, ATaskThatSomebodyCancelsStopsTheCampaignAndItsOtherTasks) {
  OnStandIn s("slurm_cancelled",
              "1|0|CANCELLED|0|0|node1|None|\n1|1|RUNNING|0|0|node1|None|\n1|2|RUNNING|0|0|node1|None|\n");
  const std::string e = error_of([&] { s.run(); });
  EXPECT_TRUE(says(e, "task 1_0")) << e;
  EXPECT_TRUE(says(e, "was cancelled by somebody")) << e;
  EXPECT_EQ(text_of(s.dir / "cancelled"), "--quiet 1\n");
  EXPECT_FALSE(fs::exists(s.dir / "slurm" / "array"));
  for (const TrialJob& j : s.jobs) EXPECT_FALSE(fs::exists(j.run_dir));
}

TEST(Slurm, ATrialThatASharedDiskShowsLateIsNotLost) {
  OnStandIn s(
      "slurm_late",
      "1|0|COMPLETED|0|0|node1|None|\n1|1|COMPLETED|0|0|node1|None|\n1|2|COMPLETED|0|0|node1|None|\n");
  std::thread disk([&] {
    wait_until([&] { return fs::exists(s.dir / "polled"); });
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    for (std::size_t i = 0; i < 3; ++i) s.fly_trial(i);
  });
  EXPECT_TRUE(s.run());
  disk.join();
  const std::string asked = text_of(s.dir / "asked");
  EXPECT_EQ(std::count(asked.begin(), asked.end(), '\n'), 1) << asked;
}

TEST(Slurm, ANodeThatFliesNothingGetsNoMoreTasks) {
  OnStandIn s("slurm_bad_node",
              "1|0|COMPLETED|0|0|node1|None|\n1|1|COMPLETED|0|0|node1|None|\n"
              "1|2|FAILED|256|0|node2|NonZeroExitCode|\n2|0|COMPLETED|0|0|node1|None|\n");
  std::thread flights([&] {
    wait_until([&] { return fs::exists(s.dir / "asked"); });
    s.fly_trial(0);
    s.fly_trial(1);
    wait_until([&] { return says(text_of(s.dir / "asked"), "--exclude"); });
    s.fly_trial(2);
  });
  EXPECT_TRUE(s.run());
  flights.join();
  EXPECT_TRUE(says(text_of(s.dir / "asked"), "--exclude=node2")) << text_of(s.dir / "asked");
  EXPECT_TRUE(says(s.said, "no further tasks for node2")) << s.said;
}

/// Slurm gives 53 as the signal of a task that it could not begin.
TEST(Slurm, ANodeThatCannotBeginATaskIsNoFailureOfItsTrial) {
  OnStandIn s("slurm_no_folder",
              "1|0|FAILED|4021|0|node7|JobLaunchFailure|\n2|0|FAILED|4021|0|node7|JobLaunchFailure|\n");
  s.jobs.resize(1);
  const std::string error = error_of([&] { s.run(); });
  EXPECT_TRUE(says(error, "could not fly its trials")) << error;
  EXPECT_FALSE(is_flown(s.jobs[0]));
}

TEST(Slurm, TasksThatSlurmDoesNotKnowAreNoFailedTrials) {
  OnStandIn s("slurm_forgotten", "");
  s.jobs.resize(1);
  s.options.late_s = 0.3;
  const std::string error = error_of([&] { s.run(); });
  EXPECT_TRUE(says(error, "how is not known any more")) << error;
  EXPECT_FALSE(is_flown(s.jobs[0]));
}

TEST(Slurm, AnAnswerThatIsNotUnderstoodStopsTheCampaign) {
  OnStandIn s("slurm_strange", "JOBID STATE\n1_0 R\n");
  const std::string error = error_of([&] { s.run(); });
  EXPECT_TRUE(says(error, "its answer is not understood: JOBID STATE")) << error;
  EXPECT_FALSE(is_flown(s.jobs[0]));
}

TEST(Slurm, WhatAUserFiltersFromSqueueIsSeenAllTheSame) {
  OnStandIn s("slurm_filtered", "1|0|CANCELLED|0|0|node1|None|\n");
  s.jobs.resize(1);
  setenv("SQUEUE_PARTITION", "other", 1);
  const std::string error = error_of([&] { s.run(); });
  unsetenv("SQUEUE_PARTITION");
  EXPECT_TRUE(says(error, "was cancelled by somebody")) << error;
}

TEST(Slurm, ReadsHowTasksAre) {
  const TaskStates states = read_queue(
      "12                  |3           |OUT_OF_MEMORY       |0           |0       |node3      |None  |\n"
      "12                  |4           |FAILED              |9           |0       |node4      |None  |\n"
      "12                  |N/A         |PENDING             |0           |0       |           |None  |\n"
      "12                  |5           |PENDING             |0           |1       |           |BeginTime|\n"
      "squeue: error: something\n");
  ASSERT_EQ(states.size(), 3u);
  EXPECT_EQ(states.at({"12", 3}).text(), "OUT_OF_MEMORY on node3");
  EXPECT_TRUE(states.at({"12", 3}).is_over());
  EXPECT_EQ(states.at({"12", 4}).text(), "FAILED by signal 9 on node4");
  EXPECT_FALSE(states.at({"12", 4}).gave_up());
  EXPECT_FALSE(states.at({"12", 5}).is_over());
  EXPECT_EQ(states.at({"12", 5}).restarts, 1);
}

TEST(Slurm, ATaskFliesAsManyTrialsAtOnceAsItHasCpus) {
  const fs::path dir = fresh_folder("slurm_cpus");
  Batch batch{{}, "/bin/true", dir / "flying", 60};
  for (const char* name : {"a", "b", "c"}) {  // each ends when all three have begun
    const std::string mark = (dir / "begun").string();
    batch.trials.push_back({{"/bin/sh", "-c",
                             "mkdir -p " + mark + "; : > " + mark + "/" + name + "; while [ $(ls " + mark +
                                 " | wc -l) -lt 3 ]; do sleep 0.02; done",
                             "trial"},
                            dir / "trials" / name,
                            name});
  }
  write_batch(dir / "0.json", batch);
  setenv("SLURM_CPUS_ON_NODE", "3", 1);
  EXPECT_TRUE(fly_batch(dir / "0.json", nullptr));
  unsetenv("SLURM_CPUS_ON_NODE");
  for (const TrialJob& t : batch.trials) EXPECT_EQ(read_note(t.run_dir).end.exit_code, 0);
}

}  // namespace
}  // namespace karst::campaign
