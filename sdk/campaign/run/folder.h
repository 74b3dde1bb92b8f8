// A campaign's folder: the store, the mission files, the trials' run directories; and a lock that prevents
// two campaigns from writing to one folder.
//
//   campaign.sqlite                       store.h
//   missions/CONTESTANT/CAVE.info         flown with `karst fly FILE --seed N`
//   trials/CONTESTANT/CAVE/SEED/          a run directory, with output.txt and trial.json
//   caves/                                shared by evaluations: sdk/evaluation/reachable/reachable_file.h
//   flying/                               running trials
#pragma once
#include <filesystem>
#include <string>

#include "sdk/campaign/plan/plan.h"

namespace karst::campaign {

/// Holds the lock for its lifetime, however the process ends. Throws core::InputError if it is taken.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

/// Opens or creates the folder's store for a plan; the metric declared first is kept. Throws
/// core::InputError, naming the difference in `source` (the campaign's file), if the folder contains a
/// different campaign.
Store open_for(const Plan& plan, const std::filesystem::path& folder, AcceptedBinaries binaries,
               const std::string& source = "what is there now");

std::filesystem::path mission_file(const Plan& plan, const TrialKey& trial);  // relative to the folder
/// Writes all mission files.
void write_missions(const Plan& plan, const std::filesystem::path& folder);

}  // namespace karst::campaign
