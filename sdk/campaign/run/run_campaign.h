// Flies a campaign to its end, or goes on with one that was stopped, killed or appended to.
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

/// What stays of each trial.
enum class Keep {
  figures,  // metrics, mission, timing, what it printed
  replay,   // and all that reports and replays show; no map.ot, map.ply
  all
};
constexpr auto names_of(Keep) {
  using enum Keep;
  return std::to_array<core::Named<Keep>>({{figures, "figures"}, {replay, "replay"}, {all, "all"}});
}

/// Where trials fly.
enum class Where { local, slurm };
constexpr auto names_of(Where) {
  using enum Where;
  return std::to_array<core::Named<Where>>({{local, "local"}, {slurm, "slurm"}});
}

/// What is known while it runs.
struct Progress {
  std::size_t trials = 0;    // of the campaign
  std::size_t finished = 0;  // of these, now and before
  std::size_t here = 0;      // finished since this start
  std::size_t failed = 0;
  std::size_t flying = 0;
  double wall_s = 0;                  // since this start
  double simulated_s = 0;             // flown since this start
  const StoredTrial* last = nullptr;  // that has just ended; null at a tick
};

struct RunOptions {
  std::filesystem::path folder;
  std::filesystem::path karst;  // the program that flies
  Where executor = Where::local;
  std::vector<std::string> sbatch;  // further options of sbatch
  std::size_t batch = 0;            // trials a Slurm task flies; 0: as many as are ten seconds of work
  std::size_t jobs = 1;
  Keep keep = Keep::replay;
  AcceptedBinaries binaries = AcceptedBinaries::same;
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const Plan&, const Progress&)> progress;
};

/// Without `campaign` it goes on with the one in the folder. Returns false if it was stopped. Everything that
/// can be wrong is said, as core::InputError, before anything flies.
bool run_campaign(const std::optional<Campaign>& campaign, const RunOptions& options);

}  // namespace karst::campaign
