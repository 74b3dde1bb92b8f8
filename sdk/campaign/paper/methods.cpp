#include "sdk/campaign/paper/methods.h"

#include <algorithm>
#include <set>
#include <utility>

#include "core_stack/common/counted.h"
#include "sdk/campaign/paper/contestant_text.h"
#include "sdk/campaign/paper/restricted_time.h"
#include "sdk/campaign/plan/profile.h"
#include "sdk/campaign/verdict/figure_words.h"

namespace karst::campaign {
namespace {

using core::counted;

std::string flights_sentence(const CampaignResults& results) {
  return "Campaign " + results.name + " compared " + counted(results.contestants.size(), "contestant") +
         " in " + counted(results.caves.size(), "cave") + ": " + counted(results.trials.size(), "flight") +
         " were simulated.";
}

/// The versions that flew, each once. A version names program and vehicle by a hash, and behind a point the
/// policy's plugin.
std::string versions_sentence(const std::vector<TrialExtras>& extras) {
  std::set<std::string> versions;
  for (const TrialExtras& e : extras) versions.insert(e.binary_version);
  versions.erase("");
  if (versions.empty()) return "The version of karst was not recorded.";
  return std::string("karst flew them in the ") + (versions.size() == 1 ? "version " : "versions ") +
         listed(std::vector<std::string>(versions.begin(), versions.end())) +
         " (version, hash of the program with its vehicle, hash of the policy's plugin).";
}

std::string contestants_sentence(const CampaignResults& results) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < results.contestants.size(); ++i) all.push_back(contestant_text(results, i));
  return std::string("The ") + (all.size() == 1 ? "contestant was " : "contestants were ") + listed(all) +
         ", each with the version of its policy and what sets it apart from others of this policy.";
}

std::string caves_sentence(const CampaignResults& results) {
  std::vector<std::string> names;
  for (const CaveEntry& c : results.caves) names.push_back(c.name);
  return std::string("The ") + (names.size() == 1 ? "cave was " : "caves were ") + listed(names) + ".";
}

std::string seeds_sentence(const CampaignResults& results) {
  std::set<std::int64_t> seeds;
  for (const TrialResult& t : results.trials) seeds.insert(t.seed);
  if (seeds.empty()) return "No seed was flown.";
  const auto span = static_cast<std::uint64_t>(*seeds.rbegin() - *seeds.begin());
  std::vector<std::string> numbers;
  for (const std::int64_t s : seeds) numbers.push_back(std::to_string(s));
  const bool in_a_row = numbers.size() > 2 && span == numbers.size() - 1;
  return counted(numbers.size(), "seed") + (numbers.size() == 1 ? " was" : " were") +
         " flown in each cave (" + (in_a_row ? numbers.front() + " to " + numbers.back() : listed(numbers)) +
         "); flights of the same cave and seed share start, noise, gusts and faults.";
}

/// The reserve is part of the flight time; "" if it is not known.
std::string reserve_text(const CampaignResults& results) {
  const auto reserve = std::find_if(results.shared.begin(), results.shared.end(),
                                    [](const auto& s) { return s.first == "mission.home_reserve"; });
  if (reserve == results.shared.end() || results.flight_time.empty()) return "";
  return " (this includes the way home and a reserve of " + reserve->second + ")";
}

std::string conditions_sentence(const CampaignResults& results) {
  std::string text = "The flight time was " +
                     (results.flight_time.empty() ? "not recorded" : results.flight_time) +
                     reserve_text(results) + ", and the horizon of figures over time was " +
                     fixed_text(results.horizon_s, 0) + " s";
  const auto known = std::find_if(profiles().begin(), profiles().end(),
                                  [&](const Profile& p) { return p.name == results.profile; });
  if (results.profile.empty()) return text + ".";
  return text + "; the profile was " + results.profile +
         (known == profiles().end() ? "" : " (" + known->meaning + ")") + ".";
}

std::string metric_sentence(const CampaignResults& results, const VerdictOptions& options) {
  const auto& figure =
      evaluation::metric_definitions()[static_cast<std::size_t>(evaluation::metric_index(options.metric))];
  return "Contestants are compared in " + subject_of(figure) + " (" + options.metric + ": " +
         std::string(figure.meaning) + "), " +
         (options.metric == results.metric
              ? "which was declared before the first flight."
              : "although " + results.metric + " was declared before the first flight.");
}

/// What the times in the ranking's table are.
std::string restricted_sentence(const CampaignResults& results, const VerdictOptions& options) {
  const int primary = evaluation::metric_index(options.metric);
  std::vector<int> metrics;
  if (is_restricted_time(primary)) metrics.push_back(primary);
  for (const std::string_view name : headline_figures())
    if (const int metric = evaluation::metric_index(name); metric != primary && is_restricted_time(metric))
      metrics.push_back(metric);
  return restricted_text(metrics, results.horizon_s) + ".";
}

/// docs/statistics.md in short.
std::vector<std::string> statistics_sentences(const CampaignResults& results, const VerdictOptions& options) {
  const std::size_t n = results.contestants.size();
  const std::string level = fixed_text(100 * (1 - options.alpha), 0) + " %";
  std::vector<std::string> sentences = {
      "Means are over caves, with equal weight, of the means over their flights.",
      "Intervals are " + level + " confidence intervals of a percentile bootstrap (" +
          std::to_string(options.resamples) +
          " resamples) that draws seeds within each cave, widened for small samples by the ratio of "
          "Student's quantile to the normal one and by the ratio of the unbiased variance to that of the "
          "resamples."};
  if (n < 2) return sentences;
  sentences.push_back(
      "Two contestants are compared by the differences of their flights with the same cave and seed, with "
      "Wilcoxon's signed-rank test, two-sided, exact for up to 50 differences" +
      (n > 2 ? "; its p-values are corrected with Holm's method over " + std::to_string(n * (n - 1) / 2) +
                   " pairs of contestants."
             : std::string(".")));
  sentences.push_back("A difference counts as shown if its interval excludes zero and p is below " +
                      fixed_text(options.alpha, decimals_for(options.alpha, 1)) + ".");
  return sentences;
}

std::string failures_sentence(const CampaignResults& results) {
  std::vector<std::size_t> failed(results.contestants.size());
  for (const TrialResult& t : results.trials) failed[t.contestant] += t.failed;
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < failed.size(); ++i)
    if (failed[i] > 0) parts.push_back(std::to_string(failed[i]) + " of " + results.contestants[i].name);
  if (parts.empty()) return "No flight failed.";
  return "Flights that failed (the simulation crashed, hung or could not start): " + listed(parts) +
         "; they count with what they had reached, and a value that is not in their record counts as the "
         "worst.";
}

/// Flights that no comparison in the primary figure uses; "" if there are none.
std::string left_out_sentence(const Verdicts& verdicts) {
  std::size_t unpaired = 0, unknown = 0;
  for (const Comparison& c : verdicts.comparisons) {
    if (c.metric != verdicts.metric) continue;
    unpaired += c.unpaired;
    unknown += c.unknown;
  }
  if (unpaired + unknown == 0) return "";
  return "Over all pairs of contestants, " + counted(unpaired, "flight") + " without a partner and " +
         counted(unknown, "pair") + " of flights of which the figure is not known were left out.";
}

}  // namespace

std::vector<std::string> methods_sentences(const ResultsWithExtras& campaign, const Verdicts& verdicts,
                                           const VerdictOptions& options) {
  const CampaignResults& results = campaign.results;
  std::vector<std::string> sentences = {
      flights_sentence(results),         versions_sentence(campaign.extras),
      contestants_sentence(results),     caves_sentence(results),
      seeds_sentence(results),           conditions_sentence(results),
      metric_sentence(results, options), restricted_sentence(results, options)};
  for (std::string& s : statistics_sentences(results, options)) sentences.push_back(std::move(s));
  sentences.push_back(failures_sentence(results));
  if (std::string left_out = left_out_sentence(verdicts); !left_out.empty())
    sentences.push_back(std::move(left_out));
  return sentences;
}

}  // namespace karst::campaign
