#include <cmath>
#include <limits>

#include "core_stack/common/rounded.h"
#include "sdk/campaign/verdict/verdict_parts.h"

namespace karst::campaign {
namespace {

/// Figures have six decimals. Differences are rounded likewise, or equal ones would not be exact ties.
void add_pair(const TrialResult& a, double figure_a, double figure_b, Comparison& c) {
  c.pair_a.push_back(figure_a);
  c.pair_b.push_back(figure_b);
  c.pair_cave.push_back(a.cave);
  c.pair_seed.push_back(a.seed);
  if (c.per_cave.empty() || c.per_cave.back().cave != a.cave) c.per_cave.push_back({.cave = a.cave});
  CaveComparison& cave = c.per_cave.back();
  ++cave.pairs;
  cave.mean_a += figure_a;
  cave.mean_b += figure_b;
}

}  // namespace

void pair_trials(const std::vector<const TrialResult*>& trials_a,
                 const std::vector<const TrialResult*>& trials_b, double horizon_s, Comparison& c) {
  for (const TrialResult* t : trials_a) c.failed_a += t->failed;
  for (const TrialResult* t : trials_b) c.failed_b += t->failed;
  auto a = trials_a.begin(), b = trials_b.begin();
  while (a != trials_a.end() && b != trials_b.end()) {
    const std::pair key_a((*a)->cave, (*a)->seed), key_b((*b)->cave, (*b)->seed);
    if (key_a != key_b) {
      key_a < key_b ? ++a : ++b;
      ++c.unpaired;
      continue;
    }
    const double figure_a = figure_of(**a, c.metric, horizon_s),
                 figure_b = figure_of(**b, c.metric, horizon_s);
    if (std::isfinite(figure_a) && std::isfinite(figure_b)) {
      add_pair(**a, figure_a, figure_b, c);
    } else {
      ++c.unknown;
    }
    ++a;
    ++b;
  }
  c.unpaired += static_cast<std::size_t>((trials_a.end() - a) + (trials_b.end() - b));

  c.pairs = c.pair_a.size();
  c.caves = c.per_cave.size();
  if (c.pairs == 0) c.mean_a = c.mean_b = std::numeric_limits<double>::quiet_NaN();
  for (CaveComparison& cave : c.per_cave) {
    const auto n = static_cast<double>(cave.pairs), caves = static_cast<double>(c.caves);
    cave.mean_a /= n;
    cave.mean_b /= n;
    cave.difference = cave.mean_a - cave.mean_b;
    c.mean_a += cave.mean_a / caves;
    c.mean_b += cave.mean_b / caves;
  }
}

evaluation::Differences differences_of(const Comparison& c) {
  evaluation::Differences differences;
  for (std::size_t i = 0; i < c.pairs; ++i) {
    if (i == 0 || c.pair_cave[i] != c.pair_cave[i - 1]) differences.emplace_back();
    differences.back().push_back(core::to_millionths(c.pair_a[i] - c.pair_b[i]));
  }
  return differences;
}

}  // namespace karst::campaign
