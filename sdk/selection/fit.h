// Chooses what the likeness of caves and conditions is measured by: what predicts best how contestants do in
// caves that are left out.
#pragma once
#include "sdk/selection/prediction.h"

namespace karst::selection {

/// The kernel, and the mean squared error of predicting a contestant's result in a left-out cave, relative to
/// the level there.
struct Fit {
  Kernel kernel;
  double error = kUnknown;            // of this kernel
  double error_all_alike = kUnknown;  // if all caves count alike, under the same conditions
};

/// Figures are added one by one, the most useful first, with the bandwidth that suits them. One is added only
/// if the error in left-out caves shrinks by more than its standard error over the caves: with few caves
/// something always seems to predict. If nothing does, all caves count alike.
Fit fit(const Experience& experience, const Values& values, const std::vector<double>& level);

}  // namespace karst::selection
