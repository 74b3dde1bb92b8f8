// Quantiles for intervals and forecasts.
#pragma once

namespace karst::evaluation {

/// The p-quantile of Student's t distribution with `degrees` of freedom (any positive number).
double student_t_quantile(double p, double degrees);
double normal_quantile(double p);
double chi_squared_quantile(double p, double degrees);

}  // namespace karst::evaluation
