// Mean and variance of paired differences over caves with equal weight.
#pragma once
#include "sdk/evaluation/statistics/statistics.h"

namespace karst::evaluation {

/// The mean of cave means and its variance: with s_c^2 the variance within cave c (of n_c pairs) and C caves,
/// var = sum(s_c^2 / n_c) / C^2, with degrees of freedom after Welch and Satterthwaite.
struct Spread {
  double mean = 0;
  double variance = 0;  // of the mean, unbiased
  double plug_in = 0;   // of the mean, when resampling within caves: each s_c^2 times (n_c - 1) / n_c
  double degrees = 0;   // of freedom; 0 where no difference varies
};

/// NaN unless every cave that has pairs has at least two.
Spread spread_within_caves(const Differences& differences);

double mean_of(const std::vector<double>& values);
/// Unbiased variance of at least two values.
double variance_of(const std::vector<double>& values);

}  // namespace karst::evaluation
