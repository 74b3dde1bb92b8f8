// The files that a flight writes into its run directory (docs/run_directory.md): none may exist before it,
// and none remains if nothing flew.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

namespace karst::flight {

/// The path as given, without `x/..`, because it is checked before its parent directories are created.
std::filesystem::path run_dir_of(const std::string& out);

/// Throws core::InputError if `folder` is the run directory of a flight or team: it takes no other results.
void refuse_run(const std::filesystem::path& folder);

/// Throws core::InputError naming one of these files that exists already.
void refuse_taken(const std::filesystem::path& run_dir);

/// What becomes of a flight that is in the directory already.
enum class OldRun : std::uint8_t { kept, replaced };

/// Reserves a run directory: unless the claim is kept, everything written since is removed again.
class RunClaim {
 public:
  /// Creates the directory and locks it. Refuses one that is in use or locked, and leaves it unchanged. With
  /// OldRun::replaced the files of these names, and those of a team's robots, are removed first, but only if
  /// there is a mission.info that karst wrote; any other file stays.
  explicit RunClaim(std::filesystem::path run_dir, OldRun old = OldRun::kept);
  ~RunClaim();
  RunClaim(const RunClaim&) = delete;
  RunClaim& operator=(const RunClaim&) = delete;
  void keep() { kept_ = true; }

 private:
  std::filesystem::path run_dir_;
  int lock_ = -1;  // descriptor of run.lock, locked as long as the process lives
  bool was_there_ = false, kept_ = false;
};

/// Removes the run.lock that a flight left behind when it was killed. Throws core::InputError if the flight
/// still writes there.
void remove_stale_lock(const std::filesystem::path& run_dir);

}  // namespace karst::flight
