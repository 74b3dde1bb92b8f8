#include "sdk/campaign/run/run_campaign.h"

#include <algorithm>
#include <chrono>
#include <set>

#include "core_stack/common/error.h"
#include "sdk/campaign/run/collect.h"
#include "sdk/campaign/run/executor.h"
#include "sdk/campaign/run/slurm.h"
#include "sdk/campaign/run/slurm_batch.h"

namespace karst::campaign {
namespace {

namespace fs = std::filesystem;
using core::InputError;

constexpr std::size_t kTrialsStoredAtOnce = 100;

std::vector<std::string> dropped(Keep keep) {
  std::vector<std::string> files;
  if (keep == Keep::all) return files;
  files = {"map.ot", "map.ply"};
  if (keep == Keep::figures)
    files.insert(files.end(),
                 {"map.bt", "map_growth.bin", "ground_truth.tum", "trajectory.tum", "telemetry.csv",
                  "localization.csv", "events.jsonl", "truth.csv", "truth_events.jsonl", "decisions.csv"});
  return files;
}

/// A run directory, and the run directories of a team's robots in it.
std::vector<fs::path> run_dirs_in(const fs::path& run_dir) {
  std::vector<fs::path> all{run_dir};
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(run_dir, ignored))
    if (entry.is_directory(ignored) && entry.path().filename().string().starts_with("robot_"))
      all.push_back(entry.path());
  return all;
}

fs::path cave_cache_of(const RunOptions& options) { return options.folder / "caves"; }

Plan plan_for(const std::optional<Campaign>& campaign, const RunOptions& options) {
  if (campaign) {
    const bool was_there = fs::exists(options.folder);
    try {
      return make_plan(*campaign, options.karst, cave_cache_of(options));
    } catch (...) {
      std::error_code ignored;
      if (!was_there) {  // it holds what was found out about caves only, unless another campaign has begun
                         // there
        fs::remove_all(cave_cache_of(options), ignored);
        fs::remove(options.folder, ignored);
      }
      throw;
    }
  }
  const fs::path file = options.folder / "campaign.sqlite";
  return with_present_files(plan_of(Store::open(file).head().definition, file.string()), options.karst);
}

/// Ordered by seed, so that comparisons are complete early and the remaining time is predictable.
std::vector<TrialKey> in_flying_order(const Plan& plan) {
  std::vector<TrialKey> order;
  for (const std::int64_t seed : plan.seeds)
    for (std::size_t c = 0; c < plan.caves.size(); ++c)
      for (std::size_t k = 0; k < plan.contestants.size(); ++k) order.emplace_back(k, c, seed);
  return order;
}

std::string identity_of(const Plan& plan, const TrialKey& trial) {
  return mission_hash(plan, trial) + " " + plan.contestants.at(std::get<0>(trial)).binary_version;
}

TrialJob job_of(const Plan& plan, const TrialKey& trial, const RunOptions& options) {
  const auto& [contestant, cave, seed] = trial;
  TrialJob job{{options.karst.string(), "fly", (options.folder / mission_file(plan, trial)).string(),
                "--seed", std::to_string(seed), "--threads", "1", "--quiet", "--no-report", "--cave-cache",
                cave_cache_of(options).string()},
               options.folder / run_dir_of(plan, trial),
               identity_of(plan, trial)};
  if (const std::string& plugin = plan.contestants.at(contestant).plugin; !plugin.empty())
    job.command.insert(job.command.end(), {"--plugin", plugin});
  return job;
}

/// Expected wall-clock time, at 30 s of flight per second: the fastest rate seen.
double expected_trial_s(const Plan& plan) { return plan.horizon_s / 30; }

/// The binaries and their modification times: a rebuild during a campaign would fly the remaining trials with
/// another binary than their rows say.
class Binaries {
 public:
  Binaries(const Plan& plan, const RunOptions& options) : folder_(options.folder) {
    for (const fs::path& file : binaries_of(plan, options.karst)) written_.emplace_back(file, when(file));
  }
  void refuse_changed() const {
    for (const auto& [file, then] : written_)
      if (when(file) != then)
        throw InputError(file.string(), "",
                         "was changed while the campaign flew; karst compare " + folder_.string() +
                             " --any-binary goes on with what is there now");
  }

 private:
  static fs::file_time_type when(const fs::path& file) {
    std::error_code gone;
    return fs::last_write_time(file, gone);
  }
  fs::path folder_;
  std::vector<std::pair<fs::path, fs::file_time_type>> written_;
};

bool fly(const Plan& plan, const std::vector<TrialJob>& jobs, const RunOptions& options,
         const Binaries& binaries, const ExecutorEvents& events) {
  if (options.executor == Where::slurm) {
    SlurmOptions how;
    how.folder = options.folder;
    how.karst = options.karst;
    how.name = plan.name;
    how.timeout_s = plan.trial_timeout_s;
    how.expected_trial_s = expected_trial_s(plan);
    how.batch = options.batch;
    how.sbatch = options.sbatch;
    how.stop = options.stop;
    return run_on_slurm(jobs, how, events);
  }
  std::error_code ignored;
  fs::remove_all(options.folder / "flying", ignored);  // left by a killed campaign
  ExecutorOptions how{options.jobs, plan.trial_timeout_s, options.folder / "flying", {}, options.stop};
  how.finish = [&](const fs::path& run_dir) {
    binaries.refuse_changed();
    evaluate_record(options.karst, run_dir);
  };
  return run_trials(jobs, how, events);
}

}  // namespace

bool run_campaign(const std::optional<Campaign>& campaign, const RunOptions& given) {
  RunOptions options = given;
  options.folder = fs::absolute(options.folder).lexically_normal();
  if (!campaign && !fs::exists(options.folder / "campaign.sqlite"))
    throw InputError(options.folder.string(), "", "holds no campaign");
  const Plan plan = plan_for(campaign, options);
  const Binaries binaries(plan, options);
  const FolderLock lock(options.folder);
  Store store = campaign ? open_for(plan, options.folder, options.binaries, campaign->source)
                         : open_for(plan, options.folder, options.binaries);
  write_missions(plan, options.folder);

  const std::set<TrialKey> stored = store.finished();
  const std::vector<TrialKey> order = in_flying_order(plan);
  Progress progress;
  progress.trials = order.size();
  const auto begin = std::chrono::steady_clock::now();
  const auto tell = [&](const StoredTrial* trial) {
    progress.last = trial;
    progress.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (options.progress) options.progress(plan, progress);
  };
  std::error_code ignored;
  // Several that end at about the same time are one transaction. What is dropped of a trial is dropped once
  // it is stored: a campaign that dies before that collects the trial again.
  std::vector<StoredTrial> collected;
  const auto store_collected = [&] {
    store.add(collected);
    for (const StoredTrial& trial : collected)
      for (const fs::path& run_dir : run_dirs_in(options.folder / trial.result.run_dir))
        for (const std::string& file : dropped(options.keep)) fs::remove(run_dir / file, ignored);
    collected.clear();
  };
  const auto take = [&](const TrialKey& key) {
    StoredTrial trial = collect(plan, key, options.folder);
    collected.push_back(trial);
    if (collected.size() >= kTrialsStoredAtOnce) store_collected();
    ++progress.finished;
    progress.failed += trial.result.failed;
    return trial;
  };

  std::vector<TrialKey> missing;
  std::vector<TrialJob> jobs;
  for (const TrialKey& key : order) {
    const TrialJob job = job_of(plan, key, options);
    if (stored.contains(key)) {
      ++progress.finished;
    } else if (is_flown(job)) {  // the campaign died before storing it
      take(key);
    } else {
      missing.push_back(key);
      jobs.push_back(job);
    }
  }
  store_collected();
  tell(nullptr);

  ExecutorEvents events;
  events.ended = [&](std::size_t job, const ProcessEnd&) {
    binaries.refuse_changed();
    const StoredTrial trial = take(missing[job]);
    ++progress.here;
    if (trial.timing.flight.simulated_s > 0) progress.simulated_s += trial.timing.flight.simulated_s;
    tell(&trial);
  };
  events.tick = [&](std::size_t flying) {
    store_collected();
    progress.flying = flying;
    tell(nullptr);
  };
  events.say = options.say;
  events.queue = [&](const std::string& text) { progress.queue = text; };
  bool done = false;
  try {
    done = fly(plan, jobs, options, binaries, events);
  } catch (...) {  // such as a changed binary: what was collected before it counts
    try {
      store_collected();
    } catch (const InputError&) {  // the first reason is told
    }
    throw;
  }
  store_collected();
  fs::remove_all(options.folder / "flying", ignored);
  return done;
}

}  // namespace karst::campaign
