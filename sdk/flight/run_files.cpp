#include "sdk/flight/run_files.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <boost/property_tree/ptree.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "core_stack/common/error.h"
#include "core_stack/common/options.h"

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
                                  "map_cells.bin",
                                  "unsurveyed.csv",
                                  "frames.csv",
                                  "frames",
                                  "scans",
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

/// The name of the first of these files that is there; "" if there is none.
std::string run_file_in(const fs::path& run_dir) {
  std::error_code ignored;
  for (const char* file : kRunFiles)
    if (fs::exists(fs::symlink_status(run_dir / file, ignored))) return file;
  return "";
}

/// Whether karst wrote the folder's mission.info: it names the version of karst there.
bool has_mission_of_karst(const fs::path& folder) {
  const fs::path file = folder / "mission.info";
  std::error_code ignored;
  if (!fs::is_regular_file(fs::symlink_status(file, ignored))) return false;
  try {
    return core::read_info(file.string()).get_optional<std::string>("karst.version").has_value();
  } catch (const core::InputError&) {
    return false;
  }
}

void remove_run_files(const fs::path& folder) {
  std::error_code ignored;
  for (const char* file : kRunFiles) fs::remove_all(folder / file, ignored);
}

/// Of a flight, and of each robot of a team.
void remove_run(const fs::path& run_dir) {
  std::error_code ignored;
  for (int robot = 1;; ++robot) {
    const fs::path own = run_dir / ("robot_" + std::to_string(robot));
    if (!fs::is_directory(fs::symlink_status(own, ignored)) || !has_mission_of_karst(own)) break;
    remove_run_files(own);
    fs::remove(own, ignored);  // unless there is something else in it
  }
  remove_run_files(run_dir);
}

/// Throws unless the files there are those of a flight. A campaign may hold thousands of flights.
void refuse_to_replace(const fs::path& run_dir) {
  std::error_code ignored;
  if (run_file_in(run_dir).empty()) return;
  if (!has_mission_of_karst(run_dir) || fs::exists(run_dir / "campaign.sqlite", ignored))
    throw core::InputError(
        run_dir.string(), "--force",
        "replaces a run directory only, and this is none: karst wrote no mission.info there, "
        "or it holds a campaign");
}

}  // namespace

fs::path run_dir_of(const std::string& out) { return fs::path(out).lexically_normal(); }

void refuse_run(const fs::path& folder) {
  std::error_code ignored;
  for (const char* file : {"events.jsonl", "team.jsonl"})
    if (fs::exists(folder / file, ignored))
      throw core::InputError(folder.string(), file, "is that of a flight; choose another --out");
}

void refuse_taken(const fs::path& run_dir) {
  if (const std::string file = run_file_in(run_dir); !file.empty())
    throw core::InputError(
        run_dir.string(), "",
        "has files of a run already (" + file +
            "); choose another --out, or remove that folder (karst fly --force replaces it)");
}

void remove_stale_lock(const fs::path& run_dir) {
  const fs::path file = run_dir / kLock;
  const int lock = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (lock < 0) return;
  const bool is_held = flock(lock, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(lock);
  if (is_held) throw core::InputError(run_dir.string(), kLock, "a flight still writes there");
  std::error_code ignored;
  fs::remove(file, ignored);
}

RunClaim::RunClaim(fs::path run_dir, OldRun old) : run_dir_(std::move(run_dir)) {
  if (old == OldRun::replaced)
    refuse_to_replace(run_dir_);
  else
    refuse_taken(run_dir_);
  std::error_code error;
  was_there_ = fs::exists(run_dir_, error);
  fs::create_directories(run_dir_, error);
  if (error)
    throw core::InputError(run_dir_.string(), "", "the run directory cannot be made: " + error.message());
  lock_ = ::open((run_dir_ / kLock).c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (lock_ < 0 && errno == EEXIST)
    throw core::InputError(run_dir_.string(), kLock,
                           "another karst writes there, or was killed; choose another --out or remove it");
  if (lock_ < 0)
    throw core::InputError((run_dir_ / kLock).string(), "",
                           std::string("cannot be written: ") + std::strerror(errno));
  flock(lock_, LOCK_EX | LOCK_NB);                    // tells remove_stale_lock that this process lives
  if (old == OldRun::replaced) remove_run(run_dir_);  // behind the lock: no flight writes there now
}

RunClaim::~RunClaim() {
  std::error_code ignored;
  if (!kept_) remove_run_files(run_dir_);
  fs::remove(run_dir_ / kLock, ignored);
  if (lock_ >= 0) ::close(lock_);
  if (!kept_ && !was_there_) fs::remove(run_dir_, ignored);
}

}  // namespace karst::flight
