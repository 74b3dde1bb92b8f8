// Ranks, and letters for contestants that do not differ: each letter is a maximal set of contestants of which
// no two are shown to differ (the compact letter display of multiple comparisons).
#include <algorithm>
#include <cmath>
#include <map>

#include "sdk/campaign/verdict/verdict_parts.h"
#include "sdk/evaluation/metrics/metric_definitions.h"

namespace karst::campaign {
namespace {

using Group = std::vector<std::size_t>;  // ranks, ascending

using Flown = std::map<std::pair<std::size_t, std::int64_t>, double>;  // by cave and seed

/// 1: a is shown to be better than b, -1: worse, 0: not shown to differ.
int shown_better(const Verdicts& verdicts, std::size_t a, std::size_t b) {
  const Comparison* c = verdicts.find(a, b, verdicts.metric);
  if (!c || c->shown == Shown::no_difference) return 0;
  const bool first = c->shown == Shown::a_better || c->shown == Shown::a_more;
  return (c->a == a) == first ? 1 : -1;
}

/// Bron and Kerbosch, 1973: all maximal sets of contestants that are pairwise not shown to differ.
void largest_groups(const std::vector<std::vector<bool>>& alike, const Group& group, Group candidates,
                    Group excluded, std::vector<Group>& found) {
  if (candidates.empty() && excluded.empty()) found.push_back(group);
  while (!candidates.empty()) {
    const std::size_t v = candidates.front();
    const auto those_alike = [&](const Group& of) {
      Group kept;
      std::copy_if(of.begin(), of.end(), std::back_inserter(kept),
                   [&](std::size_t u) { return alike[v][u]; });
      return kept;
    };
    Group larger = group;
    larger.push_back(v);
    largest_groups(alike, larger, those_alike(candidates), those_alike(excluded), found);
    candidates.erase(candidates.begin());
    excluded.push_back(v);
  }
}

std::string letter(std::size_t i) {
  const std::string last(1, static_cast<char>('a' + i % 26));
  return i < 26 ? last : letter(i / 26 - 1) + last;
}

}  // namespace

std::vector<evaluation::Differences> comparable_figures(const CampaignResults& results, int metric) {
  std::vector<Flown> flown(results.contestants.size());
  std::map<std::pair<std::size_t, std::int64_t>, std::size_t> flown_by;
  for (const TrialResult& t : results.trials)
    if (const double f = figure_of(t, metric, results.horizon_s); std::isfinite(f)) {
      flown[t.contestant][{t.cave, t.seed}] = f;
      ++flown_by[{t.cave, t.seed}];
    }
  const bool any_shared =
      std::any_of(flown_by.begin(), flown_by.end(), [&](auto& k) { return k.second == flown.size(); });
  std::vector<evaluation::Differences> figures;
  for (const Flown& own : flown) {
    evaluation::Differences& by_cave = figures.emplace_back(results.caves.size());
    for (const auto& [key, f] : own)
      if (!any_shared || flown_by[key] == flown.size()) by_cave[key.first].push_back(f);
  }
  return figures;
}

std::vector<double> comparable_means(const CampaignResults& results, int metric) {
  std::vector<double> means;
  for (const evaluation::Differences& by_cave : comparable_figures(results, metric))
    means.push_back(evaluation::mean_difference(by_cave));
  return means;
}

std::vector<RankedContestant> rank_contestants(const Verdicts& verdicts, const CampaignResults& results) {
  const auto better = evaluation::metric_definitions()[static_cast<std::size_t>(verdicts.metric)].better;
  const std::vector<double> means = comparable_means(results, verdicts.metric);
  std::vector<RankedContestant> places;
  for (std::size_t i = 0; i < results.contestants.size(); ++i) {
    RankedContestant& place = places.emplace_back();
    place.contestant = i;
    place.mean = means[i];
  }
  std::stable_sort(places.begin(), places.end(), [&](const RankedContestant& a, const RankedContestant& b) {
    if (std::isnan(a.mean) || std::isnan(b.mean)) return !std::isnan(a.mean) && std::isnan(b.mean);
    return better == evaluation::Better::less ? a.mean < b.mean : a.mean > b.mean;
  });
  const std::size_t n = places.size();
  std::vector<std::vector<bool>> alike(n, std::vector<bool>(n, false));
  Group all;
  for (std::size_t i = 0; i < n; ++i) {
    all.push_back(i);
    places[i].worst = static_cast<int>(n);
    for (std::size_t k = 0; k < n; ++k) {
      if (i == k) continue;
      const int shown = shown_better(verdicts, places[i].contestant, places[k].contestant);
      alike[i][k] = shown == 0;
      places[i].best += shown < 0;
      places[i].worst -= shown > 0;
    }
  }
  std::vector<Group> groups;
  if (n > 0) largest_groups(alike, {}, all, {}, groups);
  std::sort(groups.begin(), groups.end());
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (const std::size_t i : groups[g]) places[i].groups += letter(g);
  return places;
}

}  // namespace karst::campaign
