// A figure as a paper prints it: its name in words, its unit, and shares in percent.
#pragma once
#include <string>

#include "sdk/evaluation/metrics/metric_definitions.h"

namespace karst::campaign {

struct PrintedFigure {
  std::string subject, heading;  // "final coverage", "Final coverage"
  std::string unit;              // of `factor` times a value; "" for counts
  std::string difference_unit;   // likewise: shares differ by percentage points
  double factor = 1;
  evaluation::Better better = evaluation::Better::neither;
};
PrintedFigure printed_figure(int metric);  // of evaluation::metric_definitions()

/// "Name (unit)", or the name alone.
std::string with_unit(const std::string& name, const std::string& unit);

/// The number with these decimals and a minus sign instead of a hyphen; a dash if it is not known.
std::string printed_number(double v, int decimals);

}  // namespace karst::campaign
