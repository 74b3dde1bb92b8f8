#include "sdk/selection/figure_words.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "core_stack/common/counted.h"
#include "core_stack/common/format_text.h"
#include "sdk/evaluation/metrics/metric_definitions.h"

namespace karst::selection {
namespace {

constexpr std::array kMetricWords{
    std::pair<std::string_view, std::string_view>{"coverage_auc", "mean coverage over the time allowed"},
    std::pair<std::string_view, std::string_view>{"coverage", "coverage at the end"},
    std::pair<std::string_view, std::string_view>{"restricted_t50_s", "time to 50 % coverage"},
    std::pair<std::string_view, std::string_view>{"restricted_t90_s", "time to 90 % coverage"},
    std::pair<std::string_view, std::string_view>{"completed", "flights that ended as planned"},
    std::pair<std::string_view, std::string_view>{"contacts", "contacts with rock in a flight"},
    std::pair<std::string_view, std::string_view>{"explored_volume_m3", "explored volume"},
    std::pair<std::string_view, std::string_view>{"exploring_speed_mps", "mean speed while exploring"},
    std::pair<std::string_view, std::string_view>{"path_length_m", "path length"},
    std::pair<std::string_view, std::string_view>{"energy_wh", "energy"}};

}  // namespace

std::string metric_words(const std::string& metric) {
  const auto* const found = std::find_if(kMetricWords.begin(), kMetricWords.end(),
                                         [&](const auto& words) { return words.first == metric; });
  return found == kMetricWords.end() ? metric : std::string(found->second);
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
  if (m.unit.empty() && m.most == 1) return core::format_text("%.0f %%", 100 * value);
  return plain_number(value) + (m.unit.empty() ? "" : " " + unit_text(std::string(m.unit)));
}

std::string share_text(double share) {
  if (share > 0 && share < 0.01) return "<1 %";
  if (share < 1 && share > 0.99) return ">99 %";
  return core::format_text("%.0f %%", 100 * share);
}

std::string unit_text(std::string text) {
  static constexpr std::string_view kCubicMetres = "m^3";
  for (std::size_t at = text.find(kCubicMetres); at != std::string::npos; at = text.find(kCubicMetres, at))
    text.replace(at, kCubicMetres.size(), "m³");
  return text;
}

}  // namespace karst::selection
