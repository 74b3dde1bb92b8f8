// What the Slurm executor does with tasks that are lost, with stand-ins for Slurm's commands; against the
// real ones: tests/closed_loop/slurm_test.sh.
#include "sdk/campaign/run/slurm.h"

#include <csignal>
#include <cstdlib>

#include "sdk/campaign/run/collect.h"
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
/// first, second ... array brings about; no task ever waits.
class StandInSlurm {
 public:
  StandInSlurm(const fs::path& dir, const fs::path& trials) : path_(std::getenv("PATH")) {
    fs::create_directories(dir / "bin");
    fs::create_directories(trials);
    write_program(dir / "bin" / "sbatch", "echo \"$*\" >> " + (dir / "asked").string() + "; n=$(wc -l < " +
                                              (dir / "asked").string() + "); mv " + (dir / "flown").string() +
                                              "/$n/* " + trials.string() + " 2>/dev/null; echo $n\n");
    write_program(dir / "bin" / "squeue", "exit 0\n");
    write_program(dir / "bin" / "scancel", "exit 0\n");
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
  SlurmOptions options;
  options.folder = dir;
  options.karst = "/bin/karst";
  options.name = "lost";
  options.batch = 3;
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

}  // namespace
}  // namespace karst::campaign
