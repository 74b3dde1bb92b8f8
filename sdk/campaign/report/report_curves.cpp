// Coverage and explored volume over time of trials with different end times, resampled to one time grid.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core_stack/common/rounded.h"
#include "sdk/campaign/report/report_parts.h"

namespace karst::campaign {
namespace {

using evaluation::Differences;
using nlohmann::ordered_json;
using Values = std::vector<double>;
using Quantity = double CurvePoint::*;

constexpr int kTimes = 101;
constexpr int kResamples = 1000;  // bands in plots need fewer than tables

/// From 0 to the horizon, however early the flights end; without a horizon, to the end of the last flight.
Values time_grid(const CampaignResults& results) {
  double end_s = 0;
  for (const TrialResult& t : results.trials)
    if (!t.curve.empty()) end_s = std::max(end_s, t.curve.back().time_s);
  if (end_s > 0 && results.horizon_s > 0) end_s = results.horizon_s;
  Values times;
  for (int i = 0; end_s > 0 && i < kTimes; ++i) times.push_back(end_s * i / (kTimes - 1));
  return times;
}

/// Linear between a trial's samples, constant before and after them: explored space stays explored. A failed
/// trial without a curve explored nothing; for other trials without a curve it is unknown.
Values on_grid(const TrialResult& trial, Quantity quantity, const Values& times) {
  if (trial.curve.empty()) return trial.failed ? Values(times.size(), 0.0) : Values();
  Values values;
  for (const double t : times) {
    const auto next = std::upper_bound(trial.curve.begin(), trial.curve.end(), t,
                                       [](double time, const CurvePoint& p) { return time < p.time_s; });
    if (next == trial.curve.begin() || next == trial.curve.end()) {
      values.push_back((next == trial.curve.begin() ? *next : trial.curve.back()).*quantity);
      continue;
    }
    const CurvePoint &a = *(next - 1), &b = *next;
    values.push_back(a.*quantity + (b.*quantity - a.*quantity) * (t - a.time_s) / (b.time_s - a.time_s));
  }
  const bool known = std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  return known ? values : Values();
}

/// Rounds to four significant digits, which draw the same line.
ordered_json short_number(double v) {
  if (!std::isfinite(v)) return nullptr;
  const double unit = v == 0 ? 1 : std::pow(10.0, 3 - std::floor(std::log10(std::abs(v))));
  return number_or_null(core::rounded(v, unit));
}

/// Mean and interval at every time; `curves[cave]` are the curves of that cave's trials.
ordered_json band(const std::vector<std::vector<const Values*>>& curves, std::size_t times,
                  const VerdictOptions& options, const evaluation::Interval& possible) {
  ordered_json mean = ordered_json::array(), low = ordered_json::array(), high = ordered_json::array();
  std::size_t n = 0;
  bool over_caves = false;
  for (const auto& of_cave : curves) n += of_cave.size();
  for (std::size_t i = 0; i < times; ++i) {
    Differences now;
    for (const auto& of_cave : curves)
      if (!of_cave.empty()) {
        now.emplace_back();
        for (const Values* curve : of_cave) now.back().push_back((*curve)[i]);
      }
    const auto [interval, from_caves] = mean_interval(now, options, kResamples, possible);
    over_caves = over_caves || from_caves;
    mean.push_back(short_number(evaluation::mean_difference(now)));
    low.push_back(short_number(interval.low));
    high.push_back(short_number(interval.high));
  }
  ordered_json row = {
      {"n", n}, {"mean", std::move(mean)}, {"low", std::move(low)}, {"high", std::move(high)}};
  if (over_caves) row["over"] = "caves";
  return row;
}

ordered_json curves_of(const CampaignResults& results, Quantity quantity, const Values& times,
                       const VerdictOptions& options, const evaluation::Interval& possible) {
  std::vector<Values> trials;
  ordered_json rows = ordered_json::array();
  for (const TrialResult& t : results.trials) {
    trials.push_back(on_grid(t, quantity, times));
    ordered_json row = ordered_json::array();
    for (const double v : trials.back()) row.push_back(short_number(v));
    rows.push_back(trials.back().empty() ? ordered_json(nullptr) : std::move(row));
  }
  ordered_json bands = ordered_json::array();
  for (std::size_t c = 0; c < results.contestants.size(); ++c) {
    std::vector<std::vector<const Values*>> by_cave(results.caves.size());
    for (std::size_t i = 0; i < trials.size(); ++i)
      if (results.trials[i].contestant == c && !trials[i].empty())
        by_cave[results.trials[i].cave].push_back(&trials[i]);
    ordered_json caves = ordered_json::array();
    for (const auto& of_cave : by_cave)
      caves.push_back(of_cave.empty() ? ordered_json(nullptr)
                                      : band({of_cave}, times.size(), options, possible));
    const bool any = std::any_of(by_cave.begin(), by_cave.end(), [](const auto& of) { return !of.empty(); });
    bands.push_back({{"all", any ? band(by_cave, times.size(), options, possible) : ordered_json(nullptr)},
                     {"caves", std::move(caves)}});
  }
  return {{"trials", std::move(rows)}, {"bands", std::move(bands)}};
}

}  // namespace

ordered_json report_curves(const CampaignResults& results, const VerdictOptions& options) {
  const Values times = time_grid(results);
  if (times.empty()) return nullptr;
  ordered_json t = ordered_json::array();
  for (const double v : times) t.push_back(number_or_null(v));
  return {{"t", std::move(t)},
          {"coverage", curves_of(results, &CurvePoint::coverage, times, options, {0, 1})},
          {"explored_m3", curves_of(results, &CurvePoint::explored_m3, times, options,
                                    {0, std::numeric_limits<double>::infinity()})}};
}

}  // namespace karst::campaign
