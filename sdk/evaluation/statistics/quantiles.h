// Quantiles that intervals and forecasts need.
#pragma once

namespace karst::evaluation {

/// The value that Student's t with `degrees` of freedom (any positive number) stays below with probability p.
double student_t_quantile(double p, double degrees);
double normal_quantile(double p);
double chi_squared_quantile(double p, double degrees);

}  // namespace karst::evaluation
