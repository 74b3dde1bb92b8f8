// Finds better parameters for a policy by flying it: each candidate flies through the same caves with the
// same seeds, so that candidates differ by their parameters and not by chance (common random numbers). The
// result is tested in held-out caves, which the search does not use.
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sdk/campaign/plan/campaign.h"
#include "sdk/campaign/verdict/verdict.h"
#include "sdk/tuning/parameter.h"
#include "sdk/tuning/search.h"

namespace karst::tuning {

struct TuneOptions {
  campaign::Campaign campaign;  // common to all: mission, profile, time, settings, caves to tune on, seeds
  campaign::ContestantSpec policy;  // with its fixed parts: other parameters, settings, plugin
  std::vector<campaign::CaveSpec> held_out;
  std::vector<Axis> axes;
  std::string metric = "coverage_auc";
  int flights = 100;  // in total, including those through held-out caves
  SearchOptions search;
};

struct Candidate {
  campaign::Settings parameters;
  double mean = 0;  // of the metric: over caves of the mean over seeds; NaN without a value
};

struct TuneResult {
  std::vector<Candidate> tried;  // the first is the default
  std::size_t best = 0;
  bool stopped = false;                                    // before the budget was used up
  std::optional<campaign::Comparison> tuned_on, held_out;  // a: tuned, b: default
};

/// Flies a campaign in a folder of this name to its end, or resumes it; none if it was stopped.
using Fly = std::function<std::optional<campaign::CampaignResults>(const campaign::Campaign&,
                                                                   const std::string& name)>;

struct TuneEvents {
  std::function<void(const Candidate& tried, std::size_t of)> tried;  // `of`: number allowed by the budget
};

/// The number of candidates that the flights allow. Throws InputError if it is less than two.
std::size_t candidates_of(const TuneOptions& options);

/// Throws InputError like `fly`, and for invalid options.
TuneResult tune(const TuneOptions& options, const Fly& fly, const TuneEvents& events = {});

}  // namespace karst::tuning
