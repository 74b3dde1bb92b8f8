// Selects a policy for a cave from the results of policies in similar caves. The method and its measured
// benefit: docs/select.md.
#pragma once
#include <string>
#include <vector>

#include "sdk/selection/cave_distance.h"

namespace karst::selection {

struct SelectOptions {
  std::string metric = "coverage_auc";
  double level = 0.9;  // of the intervals
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

struct Selected {
  bool refused = false;
  bool flown = false;             // this very cave was flown: the result rests on its flights alone
  std::string reason;             // of the selection, or of the refusal
  std::vector<NearCave> near;     // nearest first; all caves in which the metric is known
  std::vector<Expected> ranking;  // best first
  double limit = kUnknown;        // distance beyond which it refuses to select
  double bandwidth = 0;           // of the kernel; infinity: all caves have equal weight
  double confidence = 0;          // fraction of resampled experiences with the same winner
};

/// `mesh_hash`: that of campaign::mesh_hash(), "" if unknown. If two contestants have flown in this cave (the
/// same mesh, or the same figures to the sixth digit), their results there decide. Values and intervals stay
/// within what the metric can be in this cave, as in expected_figures(). Throws InputError if the experience
/// has no value of the metric, or if the description, which comes from `source`, has no figure.
Selected select(const Experience& experience, const CaveFigures& cave, const SelectOptions& options,
                const std::string& source, const std::string& mesh_hash = "");

/// The predicted figures of one contestant with the same bandwidth, by metric of the experience. None is
/// outside of what its metric can be in this cave: an explored volume is at most the coverage times the
/// volume of the cave.
std::vector<double> expected_figures(const Experience& experience, const CaveFigures& cave,
                                     const Selected& selected, std::size_t contestant);

}  // namespace karst::selection
