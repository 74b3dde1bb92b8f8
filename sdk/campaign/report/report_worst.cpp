// The trials that deserve attention first.
#include <algorithm>
#include <cmath>
#include <set>

#include "sdk/campaign/report/report_parts.h"
#include "sdk/evaluation/metrics/metric_definitions.h"

namespace karst::campaign {
namespace {

enum Kind { kFailed, kContact, kNotLanded, kNotAsMeant, kSlow };

struct Judged {
  Kind kind = kSlow;
  double against_cave = 0;  // the figure relative to the mean of its cave; signed so that less is worse
  WorstTrial worst;
};

double mean_in_cave(const CampaignResults& results, std::size_t cave, int metric) {
  double sum = 0;
  int n = 0;
  for (const TrialResult& t : results.trials) {
    const double v = figure_of(t, metric, results.horizon_s);
    if (t.cave != cave || !std::isfinite(v)) continue;
    sum += v;
    ++n;
  }
  return n > 0 ? sum / n : std::nan("");
}

bool went_wrong(const TrialResult& trial) {
  const auto completed = static_cast<std::size_t>(evaluation::metric_index("completed"));
  return trial.figures[completed] == 0;  // a team has no such figure: NaN
}

std::string with_ending(const std::string& what, const TrialResult& trial) {
  return trial.ended.empty() ? what : what + ": " + trial.ended;
}

}  // namespace

std::vector<WorstTrial> worst_trials(const CampaignResults& results, int metric, std::size_t count) {
  const auto& definition = evaluation::metric_definitions()[static_cast<std::size_t>(metric)];
  const bool less = definition.better == evaluation::Better::less;
  std::vector<double> means;
  for (std::size_t c = 0; c < results.caves.size(); ++c) means.push_back(mean_in_cave(results, c, metric));
  std::vector<Judged> judged;
  for (std::size_t i = 0; i < results.trials.size(); ++i) {
    const TrialResult& t = results.trials[i];
    const double value = figure_of(t, metric, results.horizon_s), mean = means[t.cave];
    const double fraction = std::isfinite(value) && mean > 0 ? value / mean : 1;
    const std::string text = std::to_string(std::lround(100 * fraction)) + " % of its cave's mean";
    Judged j{kSlow, less ? -fraction : fraction, {i, text}};
    if (t.failed) {
      j = {kFailed, 0, {i, "failed"}};
    } else if (t.outcome == core::name_of(core::MissionOutcome::contact)) {
      j = {kContact, j.against_cave, {i, with_ending("touched rock", t)}};
    } else if (t.outcome != core::name_of(core::MissionOutcome::landed)) {
      j = {kNotLanded, j.against_cave, {i, with_ending("did not land (" + t.outcome + ")", t)}};
    } else if (went_wrong(t)) {
      j = {kNotAsMeant, j.against_cave, {i, with_ending("did not go as planned", t)}};
    } else if (less ? fraction <= 1 : fraction >= 1) {
      continue;  // not below its cave's mean: not a bad trial
    }
    judged.push_back(std::move(j));
  }
  std::stable_sort(judged.begin(), judged.end(), [](const Judged& a, const Judged& b) {
    return a.kind != b.kind ? a.kind < b.kind : a.against_cave < b.against_cave;
  });
  std::vector<WorstTrial> worst;
  std::set<std::pair<std::size_t, std::size_t>>
      slow;  // contestants and caves with a flight listed for little more
  for (Judged& j : judged) {
    const TrialResult& t = results.trials[j.worst.trial];
    if (worst.size() == count || (j.kind == kSlow && !slow.insert({t.contestant, t.cave}).second)) continue;
    worst.push_back(std::move(j.worst));
  }
  return worst;
}

}  // namespace karst::campaign
