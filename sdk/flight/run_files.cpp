#include "sdk/flight/run_files.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "core_stack/common/error.h"

namespace karst::flight {
namespace {

namespace fs = std::filesystem;

constexpr std::array kRunFiles = {"events.jsonl",
                                  "mission.info",
                                  "telemetry.csv",
                                  "trajectory.tum",
                                  "decisions.csv",
                                  "localization.csv",
                                  "requests.bin",
                                  "policy_output.txt",
                                  "map_growth.bin",
                                  "frames.csv",
                                  "frames",
                                  "map.bt",
                                  "map.ot",
                                  "map.ply",
                                  "ground_truth.tum",
                                  "truth.csv",
                                  "truth_events.jsonl",
                                  "ground_truth_frames.csv",
                                  "timing.json",
                                  "metrics.json",
                                  "report.html",
                                  "evaluation.json",
                                  "team.jsonl",
                                  "team_truth.jsonl",
                                  "objects.json",
                                  "truth_objects.jsonl",
                                  "campaign.sqlite"};

constexpr const char* kLock = "run.lock";

}  // namespace

fs::path run_dir_of(const std::string& out) { return fs::path(out).lexically_normal(); }

void refuse_run(const fs::path& folder) {
  std::error_code ignored;
  for (const char* file : {"events.jsonl", "team.jsonl"})
    if (fs::exists(folder / file, ignored))
      throw core::InputError(folder.string(), file, "is that of a flight; choose another --out");
}

void refuse_taken(const fs::path& run_dir) {
  std::error_code ignored;
  for (const char* file : kRunFiles)
    if (fs::exists(fs::symlink_status(run_dir / file, ignored)))
      throw core::InputError(
          run_dir.string(), file,
          "is there already, of another run or your own; choose another --out or remove it");
}

RunClaim::RunClaim(fs::path run_dir) : run_dir_(std::move(run_dir)) {
  refuse_taken(run_dir_);
  std::error_code error;
  was_there_ = fs::exists(run_dir_, error);
  fs::create_directories(run_dir_, error);
  if (error)
    throw core::InputError(run_dir_.string(), "", "the run directory cannot be made: " + error.message());
  std::FILE* lock = std::fopen((run_dir_ / kLock).c_str(), "wxe");
  if (lock)
    std::fclose(lock);
  else if (errno == EEXIST)
    throw core::InputError(run_dir_.string(), kLock,
                           "another karst writes there, or was killed; choose another --out or remove it");
  else
    throw core::InputError((run_dir_ / kLock).string(), "",
                           std::string("cannot be written: ") + std::strerror(errno));
}

RunClaim::~RunClaim() {
  std::error_code ignored;
  if (!kept_)
    for (const char* file : kRunFiles) fs::remove_all(run_dir_ / file, ignored);
  fs::remove(run_dir_ / kLock, ignored);
  if (!kept_ && !was_there_) fs::remove(run_dir_, ignored);
}

}  // namespace karst::flight
