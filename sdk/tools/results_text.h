// A campaign's results as text: a table of contestants and the verdict.
#pragma once
#include <string>

#include "sdk/campaign/store/results.h"

namespace karst::tools {

/// Throws core::InputError with the most similar name if there is no such figure.
void check_metric(const std::string& metric);

/// The pairs of contestants whose verdict is printed as a sentence.
struct PairSentences {
  bool all = false;  // of more than three contestants; of fewer they are always there
  std::string of;    // if not empty: only those of this contestant
};

/// With more than three contestants, first the ranking in up to five lines and a matrix of all pairs. Throws
/// core::InputError if `metric` is not a figure, or `pairs.of` no contestant.
void print_results(const campaign::CampaignResults& results, const std::string& metric,
                   const PairSentences& pairs = {});

}  // namespace karst::tools
