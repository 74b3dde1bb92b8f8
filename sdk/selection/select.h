// Which policy for this cave: from how policies fared in caves like it. The method and what it was measured
// to be worth: docs/select.md.
#pragma once
#include <string>
#include <vector>

#include "sdk/selection/cave_distance.h"

namespace karst::selection {

struct SelectOptions {
  std::string metric = "coverage_auc";
  double level = 0.9;  // of the intervals
};

constexpr std::size_t kFewestCaves = 4;  // fewer say nothing of how far an experience carries

struct NearCave {
  std::size_t cave = 0;  // of the experience
  Distance distance;
  double weight = 0;  // share of the prediction
};

struct Expected {
  std::size_t contestant = 0;
  double value = kUnknown;                 // of the metric asked for
  double low = kUnknown, high = kUnknown;  // NaN with fewer than four caves
  double effective_caves = 0;              // how many caves the value rests on
};

struct Selected {
  bool refused = false;
  bool flown = false;             // this very cave: all rests on the flights there
  std::string reason;             // why this one, or why none
  std::vector<NearCave> near;     // nearest first, all that the metric is known of
  std::vector<Expected> ranking;  // best first
  double limit = kUnknown;        // distance beyond which it refuses
  double bandwidth = 0;           // of the kernel; infinity: caves tell nothing, and all weigh the same
  double confidence = 0;          // share of resampled experiences that name the same contestant
};

/// `mesh_hash`: SHA-256 of the cave's mesh, "" if it is not known. A cave that two contestants flew in
/// already (the same mesh, or the same figures to their sixth digit) is decided by what they found there.
/// Throws InputError if the experience knows nothing of the metric, or the description, which is of `source`,
/// has no figure.
Selected select(const Experience& experience, const CaveFigures& cave, const SelectOptions& options,
                const std::string& source, const std::string& mesh_hash = "");

/// The predicted figures of one contestant at the same bandwidth, by metric of the experience.
std::vector<double> expected_figures(const Experience& experience, const Selected& selected,
                                     std::size_t contestant);

}  // namespace karst::selection
