// Results of campaigns, reduced to the data that a selection needs: caves by their figures, contestants with
// their parameters, and each contestant's results in each cave. Stored in a small INFO file
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

/// The conditions of all flights of an experience. Figures of flights under different conditions are not
/// comparable: a longer flight covers more.
struct Conditions {
  double horizon_s = 0;  // the longest possible exploration
  std::string profile;
  std::vector<std::pair<std::string, std::string>> mission;  // campaign::CampaignResults::shared
};

/// The differences in words; "" if there are none. A setting that only one of them has does not count: it may
/// come from another version of karst.
std::string difference(const Conditions& a, const Conditions& b);

struct Experience {
  std::vector<KnownCave> caves;
  std::vector<Preset> contestants;
  std::vector<std::string> metrics;  // names of evaluation::metric_definitions()
  std::vector<Fared> fared;          // by contestant, cave, metric
  Conditions flown = {};
  std::string source = {};  // the source files, for messages

  const Fared& at(std::size_t contestant, std::size_t cave, std::size_t metric) const {
    return fared[(contestant * caves.size() + cave) * metrics.size() + metric];
  }
  Fared& at(std::size_t contestant, std::size_t cave, std::size_t metric) {
    return fared[(contestant * caves.size() + cave) * metrics.size() + metric];
  }
};

/// The metrics kept in an experience: those by which flights are compared, and others of interest beforehand.
const std::vector<std::string>& learned_metrics();

/// Leaves out caves without a description or without flights, and contestants with settings of their own
/// beside the parameters: a selection names a policy, not another vehicle. Failed trials count as in
/// campaign::figure_of. Throws InputError naming `source` if nothing is left, or if the campaign does not
/// contain its flight conditions.
Experience learn(const campaign::CampaignResults& results, const std::string& source);

/// Both experiences together; caves and contestants with equal names are identified. Throws InputError if the
/// flight conditions differ, if one name denotes two caves or two contestants (another policy, version or
/// parameters), or if both contain flights of the same pair.
Experience merged(const Experience& a, const Experience& b, const std::string& source);

/// The experience without one cave: for leave-one-out.
Experience without_cave(const Experience& experience, std::size_t cave);

/// Throws InputError with file, place and reason.
Experience read_experience(const std::string& file);
std::string to_info(const Experience& experience);

}  // namespace karst::selection
