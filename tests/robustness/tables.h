// What many trials come to: outcomes by cave and fault, and how near to rock they came.
#pragma once
#include <string>
#include <vector>

#include "tests/robustness/trial_lines.h"

namespace karst::robustness {

/// Markdown: a row a cave kind, then a row a fault, a column an outcome; the bad trials one by one; and
/// quantiles of the least clearance.
std::string summary(const std::vector<TrialLine>& trials);

/// The empirical distribution function of the least clearance as an SVG picture.
std::string clearance_plot(const std::vector<TrialLine>& trials);

}  // namespace karst::robustness
