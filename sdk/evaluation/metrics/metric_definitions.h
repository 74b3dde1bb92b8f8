// Every figure of a flight that campaigns compare: name, unit, better direction, and meaning. metrics.json,
// the store's columns, CSV, reports and the docs follow this one table (docs/metrics.md).
#pragma once
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "core_stack/common/enum_names.h"

namespace karst::evaluation {

enum class Better { more, less, neither };
constexpr auto names_of(Better) {
  using enum Better;
  return std::to_array<core::Named<Better>>({{more, "more"}, {less, "less"}, {neither, "neither"}});
}

/// The value of a failed trial if its record does not give one.
enum class IfFailed { unknown, nothing, horizon };  // left out of comparisons; 0; the campaign's horizon

struct MetricDefinition {
  std::string_view name;  // also the key in metrics.json and the column of the store
  std::string_view unit;  // "" for fractions and counts
  Better better;
  IfFailed if_failed;
  std::string_view meaning;                                          // one sentence
  double least = 0, most = std::numeric_limits<double>::infinity();  // possible range
};

std::span<const MetricDefinition> metric_definitions();

/// Its index in the table, or -1.
int metric_index(std::string_view name);

/// 1 if more is better, -1 if less is. Throws core::InputError naming `source` if there is no such figure, or
/// if it has no better direction.
double better_sign(const std::string& name, const std::string& source);

}  // namespace karst::evaluation
