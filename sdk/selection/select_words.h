// The reason for a selection, or for a refusal, in sentences.
#pragma once
#include <string>

#include "sdk/selection/leave_one_out.h"
#include "sdk/selection/select.h"

namespace karst::selection {

/// The figure that differs most: its value here, and its range in the caves flown.
std::string why_far(const Experience& experience, const CaveFigures& cave, const NearCave& nearest,
                    double limit);
/// Why the first of the ranking is proposed.
std::string why_first(const Experience& experience, const Selected& selected, const SelectOptions& options);

/// Whether all caves count alike because likeness did not foretell the policy in caves left out.
bool likeness_tells_nothing(const Selected& selected);

/// The figures by which caves are alike: "width, loops"; "" if all caves count alike.
std::string figures_in_words(const Kernel& kernel);

/// "Of the flights of lidar_uav in 42 caves, those of deep_cave did best on average in ...".
std::string best_on_average_in_words(const Experience& experience, const BestOnAverage& best,
                                     const std::string& metric);

/// "Runner-up: deep_cave, expected 66 % against 71 %"; "" without one.
std::string runner_up_in_words(const Experience& experience, const Selected& selected,
                               const std::string& metric);

/// "It rests on 1440 flights in 40 caves under 4 conditions, 360 of them in 40 caves as asked (...)".
std::string evidence_in_words(const Experience& experience, const Selected& selected,
                              const SelectOptions& options);

/// "deep_cave came first in >99 % of 1000 resamplings of the earlier flights", and how far to trust that. The
/// share is no probability that the policy is the best here.
std::string confidence_in_words(const Experience& experience, const Selected& selected);

}  // namespace karst::selection
