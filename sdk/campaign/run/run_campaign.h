// Flies a campaign to its end, or resumes one that was stopped, killed or extended.
#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core_stack/common/enum_names.h"
#include "sdk/campaign/plan/plan.h"
#include "sdk/campaign/run/folder.h"

namespace karst::campaign {

/// Which files of each trial are kept.
enum class Keep {
  figures,  // metrics, mission, timing, output
  replay,   // and all files for reports and replays; no map.ot, map.ply
  all
};
constexpr auto names_of(Keep) {
  using enum Keep;
  return std::to_array<core::Named<Keep>>({{figures, "figures"}, {replay, "replay"}, {all, "all"}});
}

/// Where trials are run.
enum class Where { local, slurm };
constexpr auto names_of(Where) {
  using enum Where;
  return std::to_array<core::Named<Where>>({{local, "local"}, {slurm, "slurm"}});
}

/// The state of a running campaign.
struct Progress {
  std::size_t trials = 0;    // of the campaign
  std::size_t finished = 0;  // of these, now and before
  std::size_t here = 0;      // of these, finished since this start
  std::size_t failed = 0;
  std::size_t flying = 0;
  double wall_s = 0;                  // since this start
  double simulated_s = 0;             // flown since this start
  std::string queue;                  // of Slurm: how many tasks run and wait
  const StoredTrial* last = nullptr;  // the trial that has just ended; null at a tick
};

struct RunOptions {
  std::filesystem::path folder;
  std::filesystem::path karst;  // the program that flies
  Where executor = Where::local;
  std::vector<std::string> sbatch;  // additional options of sbatch
  std::size_t batch = 0;            // trials per Slurm task; 0: as many as take ten seconds
  std::size_t jobs = 1;
  Keep keep = Keep::replay;
  AcceptedBinaries binaries = AcceptedBinaries::same;
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const Plan&, const Progress&)> progress;
  std::function<void(const std::string&)> say;  // what happens on Slurm, such as a lost node
};

/// Without `campaign` it resumes the one in the folder. Returns false if it was stopped. All errors of the
/// input are reported, as core::InputError, before the first flight.
bool run_campaign(const std::optional<Campaign>& campaign, const RunOptions& options);

}  // namespace karst::campaign
