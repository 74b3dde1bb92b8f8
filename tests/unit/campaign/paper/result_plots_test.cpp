// The figures of a paper, read as XML by a parser that is not karst's.
#include "sdk/campaign/paper/result_plots.h"

#include <gtest/gtest.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <cmath>
#include <cstdlib>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "sdk/campaign/report/report_parts.h"
#include "sdk/evaluation/metrics/metric_definitions.h"
#include "tests/unit/campaign/fake_campaign.h"
#include "tests/unit/campaign/paper/quick_verdict.h"

namespace karst::campaign {
namespace {

using boost::property_tree::ptree;
using test::fake_campaign;
using test::quick_verdict;

/// The plot's elements; throws if it is not well-formed.
ptree drawn(const std::string& svg) {
  std::istringstream in(svg);
  ptree document;
  boost::property_tree::read_xml(in, document);
  EXPECT_EQ(document.size(), 1u) << "one root";
  return document.get_child("svg");
}

std::string said(const ptree& element, const std::string& attribute) {
  return element.get("<xmlattr>." + attribute, "");
}
double measure(const ptree& element, const std::string& attribute) {
  return element.get<double>("<xmlattr>." + attribute);
}

/// Elements of a name directly below the root.
std::vector<ptree> elements(const ptree& svg, const std::string& name) {
  std::vector<ptree> found;
  for (const auto& [key, element] : svg)
    if (key == name) found.push_back(element);
  return found;
}

struct Frame {
  double left, top, right, bottom;
  void expect_inside(double x, double y) const {
    constexpr double kRounding = 0.011;
    EXPECT_GE(x, left - kRounding);
    EXPECT_LE(x, right + kRounding);
    EXPECT_GE(y, top - kRounding);
    EXPECT_LE(y, bottom + kRounding);
  }
};
Frame frame_of(const ptree& svg) {
  for (const ptree& r : elements(svg, "rect"))
    if (said(r, "class") == "frame")
      return {measure(r, "x"), measure(r, "y"), measure(r, "x") + measure(r, "width"),
              measure(r, "y") + measure(r, "height")};
  ADD_FAILURE() << "no frame";
  return {};
}

std::vector<std::pair<double, double>> points_of(const ptree& element) {
  std::vector<std::pair<double, double>> points;
  std::istringstream in(said(element, "points"));
  char comma = 0;
  for (double x = 0, y = 0; in >> x >> comma >> y;) points.emplace_back(x, y);
  return points;
}

std::string coverage_of(const CampaignResults& results) {
  return coverage_plot(results, report_curves(results, quick_verdict()));
}

TEST(CoveragePlot, HasOneCurveForEachContestantWithinTheAxes) {
  const CampaignResults results = fake_campaign(4, 2, 3);
  const ptree svg = drawn(coverage_of(results));
  const Frame frame = frame_of(svg);
  const auto curves = elements(svg, "polyline"), bands = elements(svg, "polygon");
  ASSERT_EQ(curves.size(), 4u);
  ASSERT_EQ(bands.size(), 4u);
  std::set<std::string> colours, dashes;
  for (const ptree& curve : curves) {
    const auto points = points_of(curve);
    ASSERT_EQ(points.size(), 101u);
    EXPECT_NEAR(points.front().first, frame.left, 0.01);
    for (std::size_t i = 0; i < points.size(); ++i) {
      frame.expect_inside(points[i].first, points[i].second);
      if (i > 0) {
        EXPECT_GT(points[i].first, points[i - 1].first) << "time goes on";
      }
    }
    colours.insert(said(curve, "stroke"));
    dashes.insert(said(curve, "stroke-dasharray"));
  }
  for (const ptree& band : bands)
    for (const auto& [x, y] : points_of(band)) frame.expect_inside(x, y);
  EXPECT_EQ(colours.size(), 4u);
  EXPECT_EQ(dashes.size(), 4u) << "lines differ without colour, too";
}

TEST(CoveragePlot, EndsAtTheMeanOfTheFlightsByItsOwnAxis) {
  const CampaignResults results = fake_campaign(2, 3, 4);
  const ptree svg = drawn(coverage_of(results));
  const Frame frame = frame_of(svg);
  double tick_y = 0, tick = 0;  // the highest number at the left
  for (const ptree& text : elements(svg, "text"))
    if (said(text, "text-anchor") == "end" && std::strtod(text.data().c_str(), nullptr) > tick) {
      tick = std::strtod(text.data().c_str(), nullptr);
      tick_y = measure(text, "y") - 2.5;  // its base line lies below the tick
    }
  ASSERT_GT(tick, 0);
  for (std::size_t c = 0; c < 2; ++c) {
    double mean = 0;
    for (const TrialResult& t : results.trials)
      if (t.contestant == c) mean += 100 * t.curve.back().coverage / 12;
    const double y = points_of(elements(svg, "polyline")[c]).back().second;
    EXPECT_NEAR(tick * (frame.bottom - y) / (frame.bottom - tick_y), mean, 0.1);
  }
}

TEST(CoveragePlot, LeavesOutAContestantThatHasNotFlown) {
  CampaignResults results = fake_campaign(3, 1, 2);
  std::erase_if(results.trials, [](const TrialResult& t) { return t.contestant == 1; });
  EXPECT_EQ(elements(drawn(coverage_of(results)), "polyline").size(), 2u);
}

TEST(CoveragePlot, OfOneFlightHasNoBand) {
  const ptree svg = drawn(coverage_of(fake_campaign(1, 1, 1)));
  EXPECT_EQ(elements(svg, "polyline").size(), 1u);
  EXPECT_TRUE(elements(svg, "polygon").empty());
}

TEST(ResultPlots, HoldAnyNameAsText) {
  CampaignResults results = fake_campaign(2, 1, 3);
  results.contestants[0].name = results.caves[0].name = "<script>&\"\x01";
  const Verdicts verdicts = compare_all(results, quick_verdict());
  for (const std::string& svg :
       {coverage_of(results), differences_plot(results, report_verdicts(verdicts)),
        caves_plot(results, report_summary(results, quick_verdict(), verdicts.metric), verdicts.metric)}) {
    bool there = false;
    for (const ptree& text : elements(drawn(svg), "text"))
      there = there || text.data().starts_with("<script>&\"?");
    EXPECT_TRUE(there) << svg;
  }
}

TEST(DifferencesPlot, HasAMarkAndAnIntervalForEachPairAroundZeroOrNot) {
  const CampaignResults results = fake_campaign(3, 2, 6);
  const Verdicts verdicts = compare_all(results, quick_verdict());
  const ptree svg = drawn(differences_plot(results, report_verdicts(verdicts)));
  const Frame frame = frame_of(svg);
  std::vector<ptree> intervals;
  double zero = -1;
  for (const ptree& line : elements(svg, "line")) {
    if (said(line, "class") == "interval") intervals.push_back(line);
    if (said(line, "stroke-dasharray") == "3 2") zero = measure(line, "x1");
  }
  const auto marks = elements(svg, "path");
  ASSERT_EQ(intervals.size(), 3u);
  ASSERT_EQ(marks.size(), 3u);
  std::vector<const Comparison*> pairs;
  for (const Comparison& c : verdicts.comparisons)
    if (c.metric == verdicts.metric) pairs.push_back(&c);
  for (std::size_t i = 0; i < 3; ++i) {
    frame.expect_inside(measure(intervals[i], "x1"), measure(intervals[i], "y1"));
    frame.expect_inside(measure(intervals[i], "x2"), measure(intervals[i], "y2"));
    if (i > 0) {
      EXPECT_GT(measure(intervals[i], "y1"), measure(intervals[i - 1], "y1")) << "one below the other";
    }
    const evaluation::Interval& interval = pairs[i]->interval;
    EXPECT_EQ(measure(intervals[i], "x1") > zero, interval.low > 0);
    EXPECT_EQ(measure(intervals[i], "x2") > zero, interval.high > 0);
    EXPECT_EQ(said(marks[i], "fill") == "#ffffff", pairs[i]->shown == Shown::no_difference);
  }
}

TEST(DifferencesPlot, KeepsZeroAndTheIntervalsOffItsFrame) {
  CampaignResults results = fake_campaign(2, 2, 6);  // one of the two far ahead everywhere: zero is at an end
  const auto metric = static_cast<std::size_t>(evaluation::metric_index("coverage_auc"));
  for (TrialResult& t : results.trials) t.figures[metric] = t.contestant == 0 ? 0.9 : 0.1;
  const ptree svg = drawn(differences_plot(results, report_verdicts(compare_all(results, quick_verdict()))));
  const Frame frame = frame_of(svg);
  constexpr double kClear_pt = 3;
  for (const ptree& line : elements(svg, "line"))
    for (const char* x : {"x1", "x2"}) {
      EXPECT_GT(measure(line, x), frame.left + kClear_pt);
      EXPECT_LT(measure(line, x), frame.right - kClear_pt);
    }
}

TEST(DifferencesPlot, BreaksALabelThatIsWiderThanAColumn) {
  const CampaignResults results = fake_campaign(2, 1, 3);
  const ptree svg = drawn(differences_plot(results, report_verdicts(compare_all(results, quick_verdict()))));
  const double wide = std::stod(said(svg, "width")), high = std::stod(said(svg, "height"));
  std::string label;
  for (const ptree& text : elements(svg, "text")) {
    const double half = 0.28 * measure(text, "font-size") * static_cast<double>(text.data().size());
    if (said(text, "text-anchor") != "middle") continue;
    EXPECT_GE(measure(text, "x") - half, 0) << text.data();
    EXPECT_LE(measure(text, "x") + half, wide) << text.data();
    EXPECT_LT(measure(text, "y"), high) << text.data();
    if (measure(text, "font-size") == 8) label += (label.empty() ? "" : " ") + text.data();
  }
  EXPECT_EQ(label, "Difference in coverage averaged over the flight (percentage points)");
}

TEST(CavesPlot, HasEveryContestantInEveryCave) {
  const CampaignResults results = fake_campaign(3, 4, 3);
  const VerdictOptions options = quick_verdict();
  const int metric = evaluation::metric_index("coverage");
  const ptree svg = drawn(caves_plot(results, report_summary(results, options, metric), metric));
  const Frame frame = frame_of(svg);
  EXPECT_EQ(elements(svg, "path").size(), 3u * 4u + 3u) << "marks, and those of the legend";
  std::size_t intervals = 0;
  for (const ptree& line : elements(svg, "line"))
    if (said(line, "class") == "interval") {
      ++intervals;
      frame.expect_inside(measure(line, "x1"), measure(line, "y1"));
      frame.expect_inside(measure(line, "x2"), measure(line, "y2"));
    }
  EXPECT_EQ(intervals, 12u);
}

TEST(ResultPlots, MakeRoomForLongNames) {
  CampaignResults results = fake_campaign(2, 1, 3);
  results.contestants[1].name = std::string(100, 'w');
  const Verdicts verdicts = compare_all(results, quick_verdict());
  const ptree svg = drawn(differences_plot(results, report_verdicts(verdicts)));
  const Frame frame = frame_of(svg);
  EXPECT_GT(frame.right - frame.left, 100);
  EXPECT_GT(frame.left, 300) << "the names stand beside it";
}

}  // namespace
}  // namespace karst::campaign
