// A campaign's results in one SQLite file (docs/compare.md). Only this module knows SQL.
//
// What is in the file does not depend on the order in which trials ended: a trial's id follows from its
// contestant, cave and seed, and what the wall clock decides stands in the table `timing` alone. Every write
// is one transaction, so that a campaign killed at any moment leaves whole trials only.
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

/// What is known of a campaign before anything flew.
struct StoreHead {
  std::string name;
  std::string definition;  // the campaign as resolved, INFO
  double horizon_s = 0;
  std::vector<ContestantEntry> contestants;
  std::vector<CaveEntry> caves;
  std::vector<std::int64_t> seeds;
};

/// What no two flights of a trial share.
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

/// An open store. All throw core::InputError naming the file and the reason: it is no store, another
/// version's, damaged, locked, on a full disk.
class Store {
 public:
  /// A new file, refused if there is one.
  static Store create(const std::filesystem::path& file, const StoreHead& head);
  /// An existing one, to add to. Another program's lock is waited for so long.
  static Store open(const std::filesystem::path& file, double lock_wait_s = 60);
  Store(Store&&) noexcept;
  Store& operator=(Store&&) noexcept;
  ~Store();

  StoreHead head() const;
  /// Appends contestants, caves and seeds and takes over the definition; what is there must stand in `head`
  /// unchanged and in the same places.
  void extend(const StoreHead& head);
  /// Replaces the figures that `karst select` compares caves by: a JSON object.
  void describe_cave(std::size_t cave, const std::string& description);
  /// With its curve and timing. Replaces what there was of this trial.
  void add(const StoredTrial& trial);
  std::set<TrialKey> finished() const;

 private:
  struct Close {
    void operator()(sqlite3* db) const;
  };
  explicit Store(std::filesystem::path file) : file_(std::move(file)) {}
  std::filesystem::path file_;
  std::unique_ptr<sqlite3, Close> db_;
};

/// The store's file in a campaign's folder; a path that is no folder is taken as it is.
std::filesystem::path store_file(const std::filesystem::path& folder_or_file);

/// Everything but timing, while a campaign runs as well as after. Takes a campaign's folder or its file.
CampaignResults read_results(const std::filesystem::path& folder_or_file);

/// What exports want beside the results.
struct TrialExtras {
  std::string binary_version, mission_hash;
  TrialTiming timing;
};
struct ResultsWithExtras {
  CampaignResults results;
  std::vector<TrialExtras> extras;  // in the order of the trials
};
/// Both of the same moment: a campaign that flies may add a trial between any two.
ResultsWithExtras read_with_extras(const std::filesystem::path& folder_or_file);

}  // namespace karst::campaign
