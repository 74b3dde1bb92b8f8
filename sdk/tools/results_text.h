// A campaign's results as text: a table of contestants and the verdict.
#pragma once
#include <string>

#include "sdk/campaign/store/results.h"

namespace karst::tools {

/// Throws core::InputError with the most similar name if there is no such figure.
void check_metric(const std::string& metric);

/// Throws core::InputError if `metric` is not a figure.
void print_results(const campaign::CampaignResults& results, const std::string& metric);

}  // namespace karst::tools
