// Results of campaigns, reduced to the data that a selection needs: caves by their figures, contestants with
// their parameters, the conditions of the flights, and each contestant's results in each cave under each
// condition. Stored in a small INFO file
// (docs/select.md).
#pragma once
#include <boost/property_tree/ptree.hpp>
#include <string>
#include <vector>

#include "sdk/campaign/store/results.h"
#include "sdk/selection/cave_figures.h"
#include "sdk/selection/condition.h"

namespace karst::selection {

struct KnownCave {
  std::string name;
  CaveFigures figures;
  std::string hash = {};  // campaign::mesh_hash(); "" if unknown
};

struct Preset {
  std::string name, policy, version;
  boost::property_tree::ptree parameters;  // in the form of a mission file
};

/// One figure of a contestant in a cave, over the flights there.
struct Fared {
  int flights = 0;                               // number of flights with a known figure
  double mean = kUnknown, deviation = kUnknown;  // deviation over seeds; NaN for fewer than two
};

/// Where flights were flown: a cave, and the conditions there. By index in the experience.
struct Site {
  std::size_t cave = 0, condition = 0;
};

struct Experience {
  std::vector<KnownCave> caves;
  std::vector<Preset> contestants;
  std::vector<Condition> conditions;
  std::vector<Site> sites;           // by condition, then cave; only pairs with flights
  std::vector<std::string> metrics;  // names of evaluation::metric_definitions()
  std::vector<Fared> fared;          // by contestant, site, metric
  std::string source = {};           // the source files, for messages

  const Fared& at(std::size_t contestant, std::size_t site, std::size_t metric) const {
    return fared[(contestant * sites.size() + site) * metrics.size() + metric];
  }
  Fared& at(std::size_t contestant, std::size_t site, std::size_t metric) {
    return fared[(contestant * sites.size() + site) * metrics.size() + metric];
  }
};

/// Gives the experience these sites, without results.
void lay_out(Experience& experience, std::vector<Site> sites);
/// Every cave under every condition.
std::vector<Site> all_sites(const Experience& experience);

/// The metrics kept in an experience: those by which flights are compared, and others of interest beforehand.
const std::vector<std::string>& learned_metrics();

/// Leaves out caves without a description or without flights, and contestants with settings of their own
/// beside the parameters: a selection names a policy, not another vehicle. Failed trials count as in
/// campaign::figure_of. Throws InputError naming `source` if nothing is left, or if the campaign does not
/// contain its flight conditions.
Experience learn(const campaign::CampaignResults& results, const std::string& source);

/// Both experiences together; caves and contestants with equal names are identified, and conditions of the
/// same kind. Throws InputError if flights differ in more than vehicle, sensors, time and team, if one name
/// denotes two caves or two contestants (another policy, version or parameters), or if both contain flights
/// of the same contestant in the same cave under the same conditions.
Experience merged(const Experience& a, const Experience& b, const std::string& source);

/// The experience without one cave: for leave-one-out.
Experience without_cave(const Experience& experience, std::size_t cave);

/// The most one may explore of the flights at a site: the limit of restricted times.
inline double horizon_s(const Experience& experience, std::size_t site) {
  return experience.conditions[experience.sites[site].condition].horizon_s;
}

/// Throws InputError with file, place and reason.
Experience read_experience(const std::string& file);
std::string to_info(const Experience& experience);

}  // namespace karst::selection
