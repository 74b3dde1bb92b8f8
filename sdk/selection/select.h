// Selects a policy for a cave and a mission from the results of policies in similar caves. The method and its
// measured benefit: docs/select.md.
#pragma once
#include <string>
#include <vector>

#include "sdk/selection/cave_distance.h"
#include "sdk/selection/fit.h"

namespace karst::selection {

struct SelectOptions {
  std::string metric = "coverage_auc";
  double level = 0.9;  // of the intervals
  AskedConditions conditions = {};
};

constexpr std::size_t kFewestCaves = 4;  // with fewer, the reach of an experience is unknown

struct NearCave {
  std::size_t cave = 0;  // index in the experience
  Distance distance;
  double weight = 0;  // fraction of the prediction
};

struct Expected {
  std::size_t contestant = 0;
  double value = kUnknown;                 // of the metric asked for
  double low = kUnknown, high = kUnknown;  // NaN with fewer than four caves
  double effective_caves = 0;              // number of caves on which the value effectively rests
};

/// How many flights the answer rests on.
struct Evidence {
  std::size_t flights = 0, caves = 0;                    // of the metric, in all
  std::size_t flights_as_asked = 0, caves_as_asked = 0;  // under the conditions asked for
};

struct Selected {
  bool refused = false;
  bool flown = false;             // this very cave was flown: the result rests on its flights alone
  std::string reason;             // of the selection, or of the refusal
  std::vector<NearCave> near;     // nearest first; all caves in which the metric is known
  std::vector<Expected> ranking;  // best first
  double limit = kUnknown;        // distance beyond which it refuses to select
  double confidence = kUnknown;   // fraction of resampled experiences with the same winner
  Fit fit;                        // what likeness is measured by
  SiteWeights weights;            // of the sites
  Evidence evidence;
};

/// `mesh_hash`: that of campaign::mesh_hash(), "" if unknown. If two contestants have flown in this cave (the
/// same mesh, or the same figures to the sixth digit) with the vehicle and team asked for, and an endurance
/// of half to twice that, their results there decide. Values and intervals stay within what the metric can be
/// in this cave, as in expected_figures(). Throws InputError if the experience has no value of the metric, or
/// if the description, which comes from `source`, has no figure.
Selected select(const Experience& experience, const CaveFigures& cave, const SelectOptions& options,
                const std::string& source, const std::string& mesh_hash = "");

/// The index of a metric in the experience, and how likeness is measured for it. Throws InputError as select.
std::size_t metric_of(const Experience& experience, const std::string& metric, const std::string& source);
Fit fit(const Experience& experience, std::size_t metric);

/// Best first by these weights; contestants that cannot be predicted are left out.
std::vector<Expected> ranking_by(const Experience& experience, std::size_t metric,
                                 const SiteWeights& weights);

/// Why conditions like these were never flown; "" if they were.
std::string why_other_conditions(const Experience& experience, const AskedConditions& asked);

/// The predicted figures of one contestant with the weights of the selection, by metric of the experience.
/// None is outside of what its metric can be in this cave: an explored volume is at most the coverage times
/// the volume of the cave, and a depth at most the length of its passages.
std::vector<double> expected_figures(const Experience& experience, const CaveFigures& cave,
                                     const Selected& selected, std::size_t contestant);

}  // namespace karst::selection
