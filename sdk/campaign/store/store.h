// A campaign's results in one SQLite file (docs/compare.md). Only this module uses SQL.
//
// The file's content does not depend on the order in which trials ended: a trial's id follows from its
// contestant, cave and seed, and all wall-clock values are in the table `timing`. Every write is one
// transaction, so that a campaign killed at any moment leaves complete trials only.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "sdk/campaign/store/results.h"
#include "sdk/evaluation/metrics/wall_clock.h"

struct sqlite3;

namespace karst::campaign {

/// The data of a campaign known before its first flight.
struct StoreHead {
  std::string name;
  std::string definition;  // the resolved campaign, INFO
  double horizon_s = 0;
  std::vector<ContestantEntry> contestants;
  std::vector<CaveEntry> caves;
  std::vector<std::int64_t> seeds;
};

/// Values that differ between two flights of the same trial.
struct TrialTiming {
  std::string machine;
  double trial_s = 0;  // of the whole process: loading, flight, evaluation
  evaluation::WallClock flight{};
};

struct StoredTrial {
  TrialResult result;  // its run_dir relative to the store
  std::string binary_version, mission_hash;
  TrialTiming timing;
};

/// Contestant and cave by index, and the seed.
using TrialKey = std::tuple<std::size_t, std::size_t, std::int64_t>;

/// An open store. All functions throw core::InputError with the file and the reason: not a store, another
/// version, damaged, locked, or disk full.
class Store {
 public:
  /// Creates a new file; refuses an existing one.
  static Store create(const std::filesystem::path& file, const StoreHead& head);
  /// Opens an existing store for writing. Waits up to this long for another program's lock.
  static Store open(const std::filesystem::path& file, double lock_wait_s = 60);
  Store(Store&&) noexcept;
  Store& operator=(Store&&) noexcept;
  ~Store();

  StoreHead head() const;
  /// Appends contestants, caves and seeds and replaces the definition; existing entries must be in `head`,
  /// unchanged and at the same indices.
  void extend(const StoreHead& head);
  /// Replaces the figures by which `karst select` compares caves: a JSON object.
  void describe_cave(std::size_t cave, const std::string& description);
  /// Adds trials with their curves and timings as one transaction, so that the disk is waited for once.
  /// Replaces previous entries of the same trials.
  void add(const std::vector<StoredTrial>& trials);
  void add(const StoredTrial& trial) { add(std::vector<StoredTrial>{trial}); }
  std::set<TrialKey> finished() const;

 private:
  struct Close {
    void operator()(sqlite3* db) const;
  };
  void write(const StoredTrial& trial, const std::vector<std::int64_t>& seeds, bool tells_ending);
  explicit Store(std::filesystem::path file) : file_(std::move(file)) {}
  std::filesystem::path file_;
  std::unique_ptr<sqlite3, Close> db_;
};

/// The store's file in a campaign's folder; a path that is not a folder is returned unchanged.
std::filesystem::path store_file(const std::filesystem::path& folder_or_file);

/// Reads everything except timing, also while the campaign runs. Takes the campaign's folder or its file.
CampaignResults read_results(const std::filesystem::path& folder_or_file);

/// Additional data of a trial for exports.
struct TrialExtras {
  std::string binary_version, mission_hash;
  TrialTiming timing;
};
struct ResultsWithExtras {
  CampaignResults results;
  std::vector<TrialExtras> extras;  // in the order of the trials
};
/// Reads both from the same snapshot: a running campaign may add trials at any time.
ResultsWithExtras read_with_extras(const std::filesystem::path& folder_or_file);

}  // namespace karst::campaign
