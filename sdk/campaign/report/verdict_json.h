// A campaign's verdict for other programs.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "sdk/campaign/store/results.h"

namespace karst::campaign {

/// The verdict about one figure; `metric` "" is the one that the campaign declared: `metric`, `declared`,
/// `subject` (in words), `unit`, `is_fraction`, `sentence`, `means` (by contestant and figure, of what
/// all of them flew), `ranking` (best first: contestant, best_place, worst_place, groups, trials, failed,
/// mean, low, high) and `pairs` (a, b, pairs, mean_a, mean_b, difference, low, high, p, rank_biserial,
/// better, sentence). Values in the figure's own unit, shares as fractions; null for what is not known. Null
/// as a whole without a trial. Throws core::InputError for an unknown figure.
nlohmann::ordered_json verdict_json(const CampaignResults& results, const std::string& metric);

}  // namespace karst::campaign
