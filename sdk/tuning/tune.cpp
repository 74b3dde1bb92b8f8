#include "sdk/tuning/tune.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core_stack/common/error.h"
#include "sdk/evaluation/metrics/metric_definitions.h"

namespace karst::tuning {
namespace {

using campaign::Campaign;
using campaign::CampaignResults;
using core::InputError;

std::string folder_name(std::size_t candidate) {
  std::array<char, 32> name;
  std::snprintf(name.data(), name.size(), "candidate%03zu", candidate);
  return name.data();
}

/// Mean over caves of the mean over seeds, as in verdicts.
double mean_of(const CampaignResults& r, std::size_t contestant, int metric) {
  std::map<std::size_t, std::pair<double, int>> caves;
  for (const campaign::TrialResult& t : r.trials) {
    const double v = campaign::figure_of(t, metric, r.horizon_s);
    if (t.contestant == contestant && std::isfinite(v)) {
      caves[t.cave].first += v;
      ++caves[t.cave].second;
    }
  }
  double sum = 0;
  for (const auto& [cave, of] : caves) sum += of.first / of.second;
  return caves.empty() ? std::numeric_limits<double>::quiet_NaN() : sum / static_cast<double>(caves.size());
}

campaign::ContestantSpec contestant(const TuneOptions& o, const std::string& name,
                                    const campaign::Settings& parameters) {
  campaign::ContestantSpec c = o.policy;
  c.name = name;
  for (const auto& setting : parameters) c.parameters.push_back(setting);
  return c;
}

Campaign campaign_of(const TuneOptions& o, std::vector<campaign::ContestantSpec> who) {
  Campaign c = o.campaign;
  c.contestants = std::move(who);
  return c;
}

campaign::Settings parameters_at(const std::vector<Axis>& axes, const Point& p) {
  campaign::Settings s;
  for (std::size_t i = 0; i < axes.size(); ++i) s.emplace_back(axes[i].id, axes[i].text(p[i]));
  return s;
}

/// The tuned parameters against the default in one set of results.
std::optional<campaign::Comparison> comparison(const CampaignResults& r, const std::string& metric) {
  campaign::VerdictOptions options;
  options.metric = metric;
  const campaign::Verdicts v = campaign::compare_all(r, options);
  const campaign::Comparison* c = v.find(0, 1, evaluation::metric_index(metric));
  return c ? std::optional(*c) : std::nullopt;
}

/// Joins two campaigns, of one contestant each, through the same caves.
CampaignResults joined(const CampaignResults& a, const CampaignResults& b) {
  CampaignResults all = a;
  all.contestants.push_back(b.contestants.front());
  for (campaign::TrialResult t : b.trials) {
    t.contestant = 1;
    all.trials.push_back(std::move(t));
  }
  return all;
}

struct Stopped {};

}  // namespace

std::size_t candidates_of(const TuneOptions& o) {
  const auto each = o.campaign.caves.size() * o.campaign.seeds.size(),
             end = 2 * o.held_out.size() * o.campaign.seeds.size();
  if (each == 0) throw InputError("tune", "", "needs caves and seeds");
  const auto flights = static_cast<std::size_t>(std::max(0, o.flights));
  if (flights < end + 2 * each)
    throw InputError("tune", "flights",
                     "are too few: a candidate takes " + std::to_string(each) + ", the caves held out " +
                         std::to_string(end) +
                         ", and two candidates are the least: " + std::to_string(end + 2 * each));
  return (flights - end) / each;
}

TuneResult tune(const TuneOptions& o, const Fly& fly, const TuneEvents& events) {
  const double sign = evaluation::better_sign(o.metric, "tune");
  const int metric = evaluation::metric_index(o.metric);
  if (const std::string whole = "restricted_" + o.metric; evaluation::metric_index(whole) >= 0)
    throw InputError(
        "tune", o.metric,
        "only flights that got there have it, and who got there less often would look better; use " + whole);
  const std::size_t most = candidates_of(o);
  for (const campaign::CaveSpec& held : o.held_out)
    for (const campaign::CaveSpec& cave : o.campaign.caves)
      if (std::filesystem::weakly_canonical(std::filesystem::absolute(held.file)) ==
              std::filesystem::weakly_canonical(std::filesystem::absolute(cave.file)) &&
          held.start == cave.start)
        throw InputError("tune", held.file, "is tuned on and held out");
  TuneResult result;
  std::vector<CampaignResults> flown;
  std::map<campaign::Settings, double> known;
  double worst = 0;  // value of a candidate with unknown results
  const auto cost = [&](const Point& p) {
    const campaign::Settings parameters = parameters_at(o.axes, p);
    if (const auto found = known.find(parameters); found != known.end()) return found->second;
    const std::string name = folder_name(flown.size());
    std::optional<CampaignResults> r =
        fly(campaign_of(o, {contestant(o, flown.empty() ? "default" : name, parameters)}), name);
    if (!r) throw Stopped();
    const Candidate candidate{parameters, mean_of(*r, 0, metric)};
    flown.push_back(std::move(*r));
    result.tried.push_back(candidate);
    const double value = std::isnan(candidate.mean) ? worst : -sign * candidate.mean;
    worst = result.tried.size() == 1 ? value : std::max(worst, value);
    if (events.tried) events.tried(candidate, most);
    return known[parameters] = value;
  };
  Point start;
  for (const Axis& a : o.axes) start.push_back(a.place(a.start));
  // Points that round to known parameters cost no flight, but their number must be bounded.
  std::size_t asked = 0;
  const auto enough = [&] { return result.tried.size() >= most || ++asked > 50 * most; };
  try {
    search(start, o.search, cost, enough);
    for (std::size_t i = 1; i < result.tried.size(); ++i)
      if (known[result.tried[i].parameters] < known[result.tried[result.best].parameters]) result.best = i;
    if (result.best == 0) return result;
    result.tuned_on = comparison(joined(flown[result.best], flown.front()), o.metric);
    if (o.held_out.empty()) return result;
    Campaign last = campaign_of(o, {contestant(o, "tuned", result.tried[result.best].parameters),
                                    contestant(o, "default", result.tried.front().parameters)});
    last.caves = o.held_out;
    const std::optional<CampaignResults> r = fly(last, "held_out");
    if (!r) throw Stopped();
    result.held_out = comparison(*r, o.metric);
  } catch (const Stopped&) {
    result.stopped = true;
  }
  return result;
}

}  // namespace karst::tuning
