// What is known of policies from campaigns, distilled to what a selection needs: caves by their figures,
// contestants with their parameters, and how each fared in each cave. A small INFO file holds it
// (docs/select.md).
#pragma once
#include <boost/property_tree/ptree.hpp>
#include <string>
#include <utility>
#include <vector>

#include "sdk/campaign/store/results.h"
#include "sdk/selection/cave_figures.h"

namespace karst::selection {

struct KnownCave {
  std::string name;
  CaveFigures figures;
  std::string hash = {};  // SHA-256 of the mesh's bytes; "" if it is not known
};

struct Preset {
  std::string name, policy, version;
  boost::property_tree::ptree parameters;  // as a mission file says them
};

/// One figure of a contestant in a cave, over the flights there.
struct Fared {
  int flights = 0;                               // whose figure is known
  double mean = kUnknown, deviation = kUnknown;  // deviation over seeds; NaN of fewer than two
};

/// How all of an experience was flown. Figures of flights that differ in any of it do not compare: a longer
/// flight covers more.
struct Conditions {
  double horizon_s = 0;  // the longest an exploration could take
  std::string profile;
  std::vector<std::pair<std::string, std::string>> mission;  // campaign::CampaignResults::shared
};

/// What differs, in words; "" if nothing does. A setting that only one of them has is none: it may be of
/// another version of karst.
std::string difference(const Conditions& a, const Conditions& b);

struct Experience {
  std::vector<KnownCave> caves;
  std::vector<Preset> contestants;
  std::vector<std::string> metrics;  // names of evaluation::metric_definitions()
  std::vector<Fared> fared;          // by contestant, cave, metric
  Conditions flown = {};
  std::string source = {};  // the files it is of, for messages

  const Fared& at(std::size_t contestant, std::size_t cave, std::size_t metric) const {
    return fared[(contestant * caves.size() + cave) * metrics.size() + metric];
  }
  Fared& at(std::size_t contestant, std::size_t cave, std::size_t metric) {
    return fared[(contestant * caves.size() + cave) * metrics.size() + metric];
  }
};

/// The metrics an experience keeps: what flights are compared by, and what else one wants to know beforehand.
const std::vector<std::string>& learned_metrics();

/// Caves that were not described, and those in which nothing flew, are left out. Contestants with settings of
/// their own beside the parameters are left out as well: a selection names a policy, not another vehicle.
/// Failed trials count as campaign::figure_of says. Throws InputError naming `source` if nothing is left, or
/// if the campaign does not tell how it flew.
Experience learn(const campaign::CampaignResults& results, const std::string& source);

/// Both together; caves and contestants of one name are one. Throws InputError if they were flown under other
/// conditions, if one name stands for two caves or for two contestants (another policy, version or
/// parameters), or if both hold flights of the same pair.
Experience merged(const Experience& a, const Experience& b, const std::string& source);

/// Without one cave: for leave-one-out.
Experience without_cave(const Experience& experience, std::size_t cave);

/// Throws InputError naming file, place and reason.
Experience read_experience(const std::string& file);
std::string to_info(const Experience& experience);

}  // namespace karst::selection
