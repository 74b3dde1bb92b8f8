#include "sdk/selection/figure_words.h"

#include <cmath>

#include "core_stack/common/counted.h"
#include "core_stack/common/format_text.h"
#include "core_stack/common/unit_text.h"
#include "sdk/campaign/verdict/figure_words.h"
#include "sdk/evaluation/metrics/metric_definitions.h"

namespace karst::selection {
std::string metric_words(const std::string& metric) {
  const int i = evaluation::metric_index(metric);
  return i < 0 ? metric : campaign::subject_of(evaluation::metric_definitions()[static_cast<std::size_t>(i)]);
}

std::string plain_number(double value) {
  const double size = std::abs(value);
  return core::format_text("%.*f", size >= 100 || size == 0 ? 0 : size >= 10 ? 1 : 2, value);
}

std::string rounded_number(double value) {
  const double size = std::abs(value);
  if (!(size >= 999.5 && size < 1e15)) return core::format_text("%.3g", value);  // no power of ten yet
  double unit = 10;
  while (size >= 999.5 * unit) unit *= 10;
  const auto rounded = static_cast<std::size_t>(std::llround(size / unit) * std::llround(unit));
  return (value < 0 ? "-" : "") + core::grouped(rounded);
}

std::string metric_value_text(const std::string& metric, double value) {
  const int i = evaluation::metric_index(metric);
  if (i < 0) return plain_number(value);
  const evaluation::MetricDefinition& m = evaluation::metric_definitions()[static_cast<std::size_t>(i)];
  if (campaign::is_fraction(m)) return core::format_text("%.0f %%", 100 * value);
  return plain_number(value) + (m.unit.empty() ? "" : " " + core::unit_text(m.unit));
}

std::string share_text(double share) {
  if (share > 0 && share < 0.01) return "<1 %";
  if (share < 1 && share > 0.99) return ">99 %";
  return core::format_text("%.0f %%", 100 * share);
}

}  // namespace karst::selection
