// What a paper says of how a campaign was flown and judged.
#pragma once
#include <string>
#include <vector>

#include "sdk/campaign/store/store.h"
#include "sdk/campaign/verdict/verdict.h"

namespace karst::campaign {

/// Sentences of plain text, in order: what was flown by which versions, contestants with the parameters in
/// which they differ, caves, seeds, profile and flight time, statistics, and failures.
std::vector<std::string> methods_sentences(const ResultsWithExtras& campaign, const Verdicts& verdicts,
                                           const VerdictOptions& options);

}  // namespace karst::campaign
