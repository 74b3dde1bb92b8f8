// A resolved campaign: it does not depend on files that may change, so that a resumed campaign flies the same
// missions as before. Stored as the store's definition.
#pragma once
#include <boost/property_tree/ptree.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sdk/campaign/plan/campaign.h"
#include "sdk/campaign/store/store.h"

namespace karst::campaign {

struct PlannedContestant {
  std::string name, policy, plugin, version;
  std::string binary_version;           // of karst and of the policy's plugin
  std::string parameters, settings;     // JSON objects, in the store's form
  boost::property_tree::ptree mission;  // all resolved settings except cave and seed
};

struct PlannedCave {
  std::string name, file, start;
  std::string mesh_hash;  // of its bytes and frame (mesh_hash.h)
  std::string hash;       // of the mesh and of the whole content of the .info file
};

struct Plan {
  std::string name, profile;
  double horizon_s = 0;        // the longest possible exploration
  double trial_timeout_s = 0;  // wall clock
  std::vector<PlannedContestant> contestants;
  std::vector<PlannedCave> caves;
  std::vector<std::int64_t> seeds;
  std::string metric = "coverage_auc";  // decides the verdict
};

/// Asks the `karst` program whether each contestant can fly in the first cave, and the first contestant in
/// every other cave, and with which settings. Throws core::InputError with the contestant or cave and the
/// reason. `cave_cache`: the folder in which trials keep what they work out of a cave; "": none.
Plan make_plan(const Campaign& campaign, const std::filesystem::path& karst,
               const std::filesystem::path& cave_cache = {});

/// The longest time all of them may explore: the flight time or the battery's endurance. Throws
/// core::InputError naming `source` if the times differ, because figures would not be comparable.
double horizon_of(const std::vector<PlannedContestant>& contestants, const std::string& source);

/// Throws core::InputError naming `source` if the flights of a contestant can never have this figure: it
/// needs a larger team, or a single vehicle instead of a team. Called before hours of flight are spent.
void refuse_figure_of_others(const std::string& metric, const std::vector<PlannedContestant>& contestants,
                             const std::string& source);

/// The plan with the current hashes of the caves and binaries. Throws core::InputError if a file is
/// gone.
Plan with_present_files(Plan plan, const std::filesystem::path& karst);

/// The existing files among those whose content determines the binary versions.
std::vector<std::filesystem::path> binaries_of(const Plan& plan, const std::filesystem::path& karst);

/// The plan as INFO text in the store's form, and its inverse.
std::string definition_of(const Plan& plan);
Plan plan_of(const std::string& definition, const std::string& source);
StoreHead head_of(const Plan& plan);

/// Whether a campaign may continue only with the karst and the plugins it began with.
enum class AcceptedBinaries { same, any };

/// The differences between `then` and `now`, one sentence each. Appended contestants, caves and seeds do not
/// count; neither do name, timeout and, if any binaries are accepted, binary versions.
std::vector<std::string> changes(const Plan& then, const Plan& now, AcceptedBinaries binaries);

/// All trials, sorted by contestant, cave, seed.
std::vector<TrialKey> trials_of(const Plan& plan);
/// The mission file (INFO) of a contestant in a cave.
std::string mission_text(const Plan& plan, std::size_t contestant, std::size_t cave);
/// Identifies what was flown: two trials of one binary with the same hash are the same flight.
std::string mission_hash(const Plan& plan, const TrialKey& trial);

}  // namespace karst::campaign
