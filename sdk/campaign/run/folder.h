// A campaign's folder: the store, the mission files, the trials' run directories; and a lock, so that two
// campaigns never write into one.
//
//   campaign.sqlite                       store.h
//   missions/CONTESTANT/CAVE.info         flown with `karst fly FILE --seed N`
//   trials/CONTESTANT/CAVE/SEED/          a run directory, with output.txt and trial.json
//   caves/                                what evaluations share: sdk/evaluation/reachable/reachable_file.h
//   flying/                               trials under way
#pragma once
#include <filesystem>
#include <string>

#include "sdk/campaign/plan/plan.h"

namespace karst::campaign {

/// Held while it lives, however the process ends. Throws core::InputError if another holds it.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

/// Opens the folder's store for a plan, or makes it; the metric that was declared first stays. Throws
/// core::InputError, naming what differs in `source` (the campaign's file), if the campaign there is another
/// one.
Store open_for(const Plan& plan, const std::filesystem::path& folder, AcceptedBinaries binaries,
               const std::string& source = "what is there now");

std::filesystem::path mission_file(const Plan& plan, const TrialKey& trial);  // in the folder
/// Writes all of them.
void write_missions(const Plan& plan, const std::filesystem::path& folder);

}  // namespace karst::campaign
