#include "sdk/tools/run_files.h"

#include <array>

#include "core_stack/common/error.h"

namespace karst::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::array kRunFiles = {"events.jsonl",
                                  "mission.info",
                                  "telemetry.csv",
                                  "trajectory.tum",
                                  "decisions.csv",
                                  "localization.csv",
                                  "requests.bin",
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
                                  "truth_objects.jsonl"};

}  // namespace

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
  std::error_code ignored;
  was_there_ = fs::exists(run_dir_, ignored);
}

RunClaim::~RunClaim() {
  if (kept_) return;
  std::error_code ignored;
  for (const char* file : kRunFiles) fs::remove_all(run_dir_ / file, ignored);
  if (!was_there_) fs::remove(run_dir_, ignored);
}

}  // namespace karst::tools
