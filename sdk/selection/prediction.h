// Predicts the results of contestants at a site, a cave under certain conditions, from those at other sites:
// the kernel-weighted mean (Nadaraya, Watson, 1964) of the sites' level times that of the contestant's
// advantage, its result over the level of the site.
#pragma once
#include <limits>
#include <vector>

#include "sdk/selection/experience.h"

namespace karst::selection {

/// Least fraction of the weight in which a contestant must have flown to be predicted.
inline constexpr double kMinFlownFraction = 0.25;

/// One metric: one value per contestant and site, NaN without flights.
struct Values {
  std::size_t contestants, sites;
  std::vector<double> mean, error;  // error of the mean, if known
  double at(std::size_t k, std::size_t s) const { return mean[k * sites + s]; }
};
Values values_of(const Experience& experience, std::size_t metric);

/// The level of each site: the mean over the contestants that flew at every site, so that levels are
/// comparable, or over all that flew there if no contestant flew everywhere.
std::vector<double> levels(const Values& values);

/// What the weight of a site follows from: the likeness of its cave and of its conditions.
struct Kernel {
  std::vector<double> scales, weights;  // of the figures; weight 0: the figure does not count
  double bandwidth = std::numeric_limits<double>::infinity();  // infinity: all caves count alike
  // What flights under other conditions count: a factor, or the spread of the logarithm in a Gaussian.
  double other_vehicle = 1, other_sensors = 1;
  double endurance_spread = std::numeric_limits<double>::infinity();
  double team_spread = std::numeric_limits<double>::infinity();
};

/// Weights of the known caves for a cave, the greatest 1. Unknown figures count as no difference here: the
/// fewer figures are known, the less the weights differ.
std::vector<double> cave_weights(const std::vector<KnownCave>& caves, const CaveFigures& cave,
                                 const Kernel& kernel);
/// Weights of the conditions for those asked for; what is not given counts as no difference.
std::vector<double> condition_weights(const std::vector<Condition>& conditions, const AskedConditions& asked,
                                      const Kernel& kernel);
/// The same for the level, which always follows the conditions: flights of the same vehicle, sensors and team
/// if there are any, those of the nearest endurance most.
std::vector<double> level_weights(const std::vector<Condition>& conditions, const AskedConditions& asked);

/// Weights of each site.
struct SiteWeights {
  std::vector<double> advantage, level;
};
SiteWeights site_weights(const Experience& experience, const CaveFigures& cave, const AskedConditions& asked,
                         const Kernel& kernel);

/// NaN for a contestant that flew in too small a fraction of the weight.
double predict(const Values& values, const std::vector<double>& level, const SiteWeights& weights,
               std::size_t contestant);

/// Whether both are the same rock: the same cave, perhaps flown from two starts.
bool same_rock(const KnownCave& a, const KnownCave& b);
/// For each cave the first one of the same rock: what is counted as one cave.
std::vector<std::size_t> rocks_of(const Experience& experience);

/// Residuals of predicting each site from those of the other caves, by contestant and site; NaN if there is
/// none.
std::vector<double> left_out_residuals(const Experience& experience, const Values& values,
                                       const std::vector<double>& level, const Kernel& kernel);

}  // namespace karst::selection
