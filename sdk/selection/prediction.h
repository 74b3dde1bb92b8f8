// What is to be expected of contestants in a cave, from how they fared in others: the kernel-weighted mean
// (Nadaraya, Watson, 1964) of a cave's level and of each contestant's advantage over it.
#pragma once
#include <vector>

#include "sdk/selection/experience.h"

namespace karst::selection {

/// One metric: a value a contestant and cave, NaN where nothing flew.
struct Values {
  std::size_t contestants, caves;
  std::vector<double> mean, error;  // error of the mean, as far as it is known
  double at(std::size_t k, std::size_t c) const { return mean[k * caves + c]; }
};
Values values_of(const Experience& experience, std::size_t metric);

/// What a cave lets one expect of any contestant: the mean over those that flew in every cave, so that it
/// means the same everywhere, or over all that flew there if none did.
std::vector<double> levels(const Values& values);

/// NaN of a contestant that flew in too little of the weight.
double predict(const Values& values, const std::vector<double>& level, const std::vector<double>& weight,
               std::size_t contestant);

/// How alike caves count.
struct Kernel {
  std::vector<double> scales;  // of the figures
  double bandwidth = 0;
};

/// Weights of the known caves for a cave. Figures that are not known count as no difference here: the fewer
/// are known, the less the weights differ.
std::vector<double> kernel_weights(const std::vector<KnownCave>& caves, const CaveFigures& cave,
                                   const Kernel& kernel);

/// What is predicted: a contestant's value, or its advantage over the cave's level.
enum class Predicted { value, advantage };

/// Residuals of predicting each cave from the others, by contestant and cave; NaN where there is none.
std::vector<double> left_out_residuals(const Experience& experience, const Values& values,
                                       const std::vector<double>& level, const Kernel& kernel,
                                       Predicted what);

/// The bandwidth at which caves left out are predicted best, in what tells contestants apart, as a share of
/// the cave's level. Infinity stands for caves that tell nothing.
double best_bandwidth(const Experience& experience, const Values& values, const std::vector<double>& level,
                      const std::vector<double>& scales);

}  // namespace karst::selection
