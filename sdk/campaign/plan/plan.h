// A campaign as resolved: nothing in it depends on files that may change, so that a campaign that is resumed
// flies what it flew before. Kept in the store as its definition.
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
  std::string parameters, settings;     // JSON objects, as the store has them
  boost::property_tree::ptree mission;  // every setting as resolved, but cave and seed
};

struct PlannedCave {
  std::string name, file, start;
  std::string mesh_hash;  // SHA-256 of the mesh's bytes
  std::string hash;       // of the mesh and of all that the .info file says
};

struct Plan {
  std::string name, profile;
  double horizon_s = 0;        // the longest an exploration can take
  double trial_timeout_s = 0;  // wall clock
  std::vector<PlannedContestant> contestants;
  std::vector<PlannedCave> caves;
  std::vector<std::int64_t> seeds;
  std::string metric = "coverage_auc";  // what the verdict is about
};

/// Asks the `karst` program for every contestant in the first cave, and in every other cave for the first
/// one, whether it can fly, and with which settings. Throws core::InputError naming the contestant or cave
/// and what is wrong with it.
Plan make_plan(const Campaign& campaign, const std::filesystem::path& karst);

/// Until when all of them may explore: the flight time, or what the battery lasts. Throws core::InputError
/// naming `source` if one may longer than another: their figures would not compare.
double horizon_of(const std::vector<PlannedContestant>& contestants, const std::string& source);

/// Throws core::InputError naming `source` if the figure is one that a contestant's flights never have: of
/// larger teams than it is, or of a vehicle alone where it is a team. Better now than after hours of flight.
void refuse_figure_of_others(const std::string& metric, const std::vector<PlannedContestant>& contestants,
                             const std::string& source);

/// The same with the hashes of the caves and binaries as they are now. Throws core::InputError if one is
/// gone.
Plan with_present_files(Plan plan, const std::filesystem::path& karst);

/// The files whose content binary versions tell, as far as they are there.
std::vector<std::filesystem::path> binaries_of(const Plan& plan, const std::filesystem::path& karst);

/// As the store keeps it: INFO, and back.
std::string definition_of(const Plan& plan);
Plan plan_of(const std::string& definition, const std::string& source);
StoreHead head_of(const Plan& plan);

/// Whether a campaign goes on only with the karst and the plugins that it began with.
enum class AcceptedBinaries { same, any };

/// What `now` changes of what `then` was, a sentence each; more contestants, caves and seeds behind those
/// there were are no change, nor are name, timeout and, with any binaries, what flies.
std::vector<std::string> changes(const Plan& then, const Plan& now, AcceptedBinaries binaries);

/// All trials: by contestant, cave, seed.
std::vector<TrialKey> trials_of(const Plan& plan);
/// The mission file of a contestant in a cave, INFO.
std::string mission_text(const Plan& plan, std::size_t contestant, std::size_t cave);
/// Tells apart what was flown: two trials of one binary with the same hash are the same flight.
std::string mission_hash(const Plan& plan, const TrialKey& trial);

}  // namespace karst::campaign
