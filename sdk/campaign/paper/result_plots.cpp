#include "sdk/campaign/paper/result_plots.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sdk/campaign/paper/printed_figure.h"
#include "sdk/campaign/paper/svg_plot.h"

namespace karst::campaign {
namespace {

using nlohmann::ordered_json;

constexpr double kCurves_pt = 150;               // height of the frame
constexpr double kRow_pt = 12, kBesides_pt = 6;  // of a row by itself, and of each further mark in it

double number_of(const ordered_json& value) {
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

std::vector<double> numbers_of(const ordered_json& list, double factor) {
  std::vector<double> numbers;
  for (const ordered_json& value : list) numbers.push_back(factor * number_of(value));
  return numbers;
}

/// What is drawn of a mean: finite numbers only.
class Range {
 public:
  void add(double v) {
    if (!std::isfinite(v)) return;
    least_ = std::min(least_, v);
    most_ = std::max(most_, v);
  }
  /// Makes room beyond the least and the greatest, so that neither lies on the plot's frame.
  void widen() {
    if (!(least_ <= most_)) return;
    constexpr double kShare = 0.05;
    const double beyond = kShare * (most_ > least_ ? most_ - least_ : 1);
    least_ -= beyond, most_ += beyond;
  }
  PlotAxis axis(int ticks, const std::string& label) const {
    return least_ <= most_ ? number_axis(least_, most_, ticks, label) : number_axis(0, 1, ticks, label);
  }

 private:
  double least_ = std::numeric_limits<double>::infinity(), most_ = -least_;
};

struct Estimate {
  double mean, low, high;
};
Estimate estimate_of(const ordered_json& mean, const ordered_json& interval, double factor) {
  return {factor * number_of(mean), factor * number_of(interval.at(0)), factor * number_of(interval.at(1))};
}

std::vector<std::string> contestant_names(const CampaignResults& results) {
  std::vector<std::string> names;
  for (const ContestantEntry& c : results.contestants) names.push_back(c.name);
  return names;
}

/// A mark with its interval in a row of a plot.
void draw(SvgPlot& plot, const Estimate& e, double row, const PlotLook& look, MarkFill fill) {
  plot.interval(e.low, e.high, row, look);
  plot.mark(e.mean, row, look, fill);
}

}  // namespace

std::string coverage_plot(const CampaignResults& results, const ordered_json& curves) {
  constexpr double kPercent = 100;
  constexpr std::size_t kMarkEvery = 20;  // samples of a curve
  const std::vector<double> times = numbers_of(curves.at("t"), 1);
  const ordered_json& bands = curves.at("coverage").at("bands");
  Range range;
  range.add(0);
  for (const ordered_json& band : bands)
    if (const ordered_json& all = band.at("all"); !all.is_null())
      for (const char* what : {"mean", "high"})
        for (const double v : numbers_of(all.at(what), kPercent)) range.add(v);
  SvgPlot plot("Coverage over time: means over all caves, with intervals",
               number_axis(0, times.back(), 6, with_unit("Time from take-off", "s")),
               range.axis(5, with_unit("Coverage", "%")), kCurves_pt, contestant_names(results));
  const auto draw_each = [&](const auto& draw_one) {
    for (std::size_t c = 0; c < bands.size(); ++c)
      if (const ordered_json& all = bands[c].at("all"); !all.is_null()) draw_one(c, all);
  };
  draw_each([&](std::size_t c, const ordered_json& all) {
    plot.band(times, numbers_of(all.at("low"), kPercent), numbers_of(all.at("high"), kPercent), plot_look(c));
  });
  draw_each([&](std::size_t c, const ordered_json& all) {
    const std::vector<double> means = numbers_of(all.at("mean"), kPercent);
    plot.curve(times, means, plot_look(c));
    // Marks of different contestants are at different times, or close curves would hide them.
    for (std::size_t k = kMarkEvery * (c + 1) / (bands.size() + 1); k < times.size(); k += kMarkEvery)
      plot.mark(times[k], means[k], plot_look(c), MarkFill::filled);
  });
  return plot.text();
}

std::string differences_plot(const CampaignResults& results, const ordered_json& verdicts) {
  const int metric = verdicts.at("metric").get<int>();
  const PrintedFigure figure = printed_figure(metric);
  std::vector<std::string> rows;
  std::vector<Estimate> estimates;
  std::vector<MarkFill> fills;
  Range range;
  range.add(0);
  for (const ordered_json& c : verdicts.at("comparisons")) {
    if (c.at("metric").get<int>() != metric) continue;
    rows.push_back(results.contestants[c.at("a").get<std::size_t>()].name + " \u2212 " +
                   results.contestants[c.at("b").get<std::size_t>()].name);
    estimates.push_back(estimate_of(c.at("difference"), c.at("interval"), figure.factor));
    fills.push_back(c.at("shown").get<std::string>().empty() ? MarkFill::hollow : MarkFill::filled);
    for (const double v : {estimates.back().mean, estimates.back().low, estimates.back().high}) range.add(v);
  }
  range.widen();
  SvgPlot plot("Differences of pairs of contestants, with intervals",
               range.axis(4, with_unit("Difference in " + figure.subject, figure.difference_unit)),
               name_axis(rows), kRow_pt * static_cast<double>(rows.size() + 1), {});
  plot.rule(0);
  for (std::size_t i = 0; i < rows.size(); ++i)
    draw(plot, estimates[i], static_cast<double>(i), plot_look(0), fills[i]);
  return plot.text();
}

std::string caves_plot(const CampaignResults& results, const ordered_json& summary, int metric) {
  const PrintedFigure figure = printed_figure(metric);
  const auto contestants = static_cast<double>(results.contestants.size()),
             caves = static_cast<double>(results.caves.size());
  std::vector<std::string> rows;
  for (const CaveEntry& cave : results.caves) rows.push_back(cave.name);
  struct Drawn {
    Estimate estimate;
    double row;
    PlotLook look;
  };
  std::vector<Drawn> all;
  Range range;
  for (std::size_t c = 0; c < results.contestants.size(); ++c)
    for (std::size_t k = 0; k < results.caves.size(); ++k) {
      const ordered_json& one = summary.at(c).at("caves").at(k);
      if (one.is_null()) continue;
      const Estimate e = estimate_of(one.at("mean"), one.at("interval"), figure.factor);
      for (const double v : {e.mean, e.low, e.high}) range.add(v);
      // Contestants lie below one another in the middle seven tenths of a row.
      const double beside = 0.7 * ((static_cast<double>(c) + 0.5) / contestants - 0.5);
      all.push_back({e, static_cast<double>(k) + beside, plot_look(c)});
    }
  SvgPlot plot(figure.heading + " by cave: means with intervals",
               range.axis(5, with_unit(figure.heading, figure.unit)), name_axis(rows),
               caves * (kRow_pt + kBesides_pt * (contestants - 1)), contestant_names(results));
  for (const Drawn& d : all) draw(plot, d.estimate, d.row, d.look, MarkFill::filled);
  return plot.text();
}

}  // namespace karst::campaign
