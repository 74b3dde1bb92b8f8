// Predicts the results of contestants in a cave from those in other caves: the kernel-weighted mean
// (Nadaraya, Watson, 1964) of a cave's level and of each contestant's advantage over it.
#pragma once
#include <vector>

#include "sdk/selection/experience.h"

namespace karst::selection {

/// One metric: one value per contestant and cave, NaN without flights.
struct Values {
  std::size_t contestants, caves;
  std::vector<double> mean, error;  // error of the mean, if known
  double at(std::size_t k, std::size_t c) const { return mean[k * caves + c]; }
};
Values values_of(const Experience& experience, std::size_t metric);

/// The level of each cave: the mean over the contestants that flew in every cave, so that levels are
/// comparable, or over all that flew there if no contestant flew everywhere.
std::vector<double> levels(const Values& values);

/// NaN for a contestant that flew in too small a fraction of the weight.
double predict(const Values& values, const std::vector<double>& level, const std::vector<double>& weight,
               std::size_t contestant);

/// Weights caves by their similarity.
struct Kernel {
  std::vector<double> scales;  // of the figures
  double bandwidth = 0;
};

/// Weights of the known caves for a cave. Unknown figures count as no difference here: the fewer figures are
/// known, the less the weights differ.
std::vector<double> kernel_weights(const std::vector<KnownCave>& caves, const CaveFigures& cave,
                                   const Kernel& kernel);

/// The predicted quantity: a contestant's value, or its advantage over the cave's level.
enum class Predicted { value, advantage };

/// Residuals of predicting each cave from the others, by contestant and cave; NaN if there is none.
std::vector<double> left_out_residuals(const Experience& experience, const Values& values,
                                       const std::vector<double>& level, const Kernel& kernel,
                                       Predicted what);

/// The bandwidth with the best predictions of left-out caves, measured by the differences between contestants
/// relative to the cave's level. Infinity means that the known caves carry no information.
double best_bandwidth(const Experience& experience, const Values& values, const std::vector<double>& level,
                      const std::vector<double>& scales);

}  // namespace karst::selection
