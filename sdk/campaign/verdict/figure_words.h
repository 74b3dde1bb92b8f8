// How a figure is spoken of and its numbers are printed, in verdicts and in papers.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sdk/evaluation/metrics/metric_definitions.h"

namespace karst::campaign {

/// "coverage averaged over the flight"; a figure without a phrase is named.
std::string subject_of(const evaluation::MetricDefinition& figure);

/// "covers less, averaged over the flight, than": what a contestant with more, or less, of it does.
std::string verb_of(const evaluation::MetricDefinition& figure, bool more);

/// Whether it is a share, which is printed in percent; differences are then in percentage points.
bool is_fraction(const evaluation::MetricDefinition& figure);

/// The figures that say most of a campaign, beside the one that decides the verdict.
std::span<const std::string_view> headline_figures();

/// Decimals with which a number as large as `scale` has so many significant digits: 0 to 6.
int decimals_for(double scale, int digits);
/// The number, which is finite, with these decimals, 0 to 6; zero has no sign.
std::string fixed_text(double v, int decimals);

/// "a", "a and b", "a, b and c".
std::string listed(const std::vector<std::string>& names);

}  // namespace karst::campaign
