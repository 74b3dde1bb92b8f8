// Finds better parameters for a policy by flying it: each candidate through the same caves with the same
// seeds, so that candidates differ by their parameters and not by their luck (common random numbers). What
// came of it is said by caves that the search never saw.
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
  campaign::Campaign campaign;  // what all share: mission, profile, time, settings, caves to tune on, seeds
  campaign::ContestantSpec policy;  // with what stays as it is: its other parameters, settings, plugin
  std::vector<campaign::CaveSpec> held_out;
  std::vector<Axis> axes;
  std::string metric = "coverage_auc";
  int flights = 100;  // in all, with those through caves held out
  SearchOptions search;
};

struct Candidate {
  campaign::Settings parameters;
  double mean = 0;  // of the metric: over caves of the mean over seeds; NaN if no trial has it
};

struct TuneResult {
  std::vector<Candidate> tried;  // the first is the default
  std::size_t best = 0;
  bool stopped = false;                                    // before the budget was spent
  std::optional<campaign::Comparison> tuned_on, held_out;  // a: tuned, b: default
};

/// Flies a campaign in a folder of this name to its end, or goes on with it; nothing if it was stopped.
using Fly = std::function<std::optional<campaign::CampaignResults>(const campaign::Campaign&,
                                                                   const std::string& name)>;

struct TuneEvents {
  std::function<void(const Candidate& tried, std::size_t of)> tried;  // `of`: how many the budget allows
};

/// How many candidates the flights allow for. Throws InputError if that is not two at least.
std::size_t candidates_of(const TuneOptions& options);

/// Throws InputError as `fly` does, and for options that make no sense.
TuneResult tune(const TuneOptions& options, const Fly& fly, const TuneEvents& events = {});

}  // namespace karst::tuning
