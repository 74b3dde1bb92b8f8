#include "sdk/campaign/report/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "core_stack/common/error.h"
#include "sdk/campaign/report/report_parts.h"
#include "sdk/evaluation/metrics/metric_definitions.h"
#include "tests/unit/campaign/fake_campaign.h"
#include "tests/unit/evaluation/fake_run.h"

namespace karst::campaign {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::fake_campaign;
using test::TemporaryDirectory;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

json data_of(const std::string& page) {
  const std::string mark = "<script type=\"application/json\" id=\"data\">";
  const std::size_t begin = page.find(mark) + mark.size();
  return json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

json written(const CampaignResults& results, const CampaignReportOptions& options = {}) {
  TemporaryDirectory dir;
  write_campaign_report(dir.path() / "report.html", results, options);
  return data_of(bytes_of(dir.path() / "report.html"));
}

double& figure(TrialResult& t, const char* name) {
  return t.figures[static_cast<std::size_t>(evaluation::metric_index(name))];
}

void expect_near(const json& shown, double v) {
  if (!std::isfinite(v)) {
    EXPECT_TRUE(shown.is_null());
  } else {
    EXPECT_NEAR(shown.get<double>(), v, 1e-5 * std::abs(v));
  }
}

TEST(CampaignReport, HoldsEveryTrialAsItWas) {
  CampaignResults results = fake_campaign(3, 2, 4);
  figure(results.trials[5], "map_error_mean_m") = kUnknown;
  const json d = written(results);
  EXPECT_EQ(d["contestants"].size(), 3u);
  EXPECT_EQ(d["caves"][1]["name"], "cave_2");
  ASSERT_EQ(d["trials"].size(), results.trials.size());
  for (std::size_t i = 0; i < results.trials.size(); ++i) {
    const TrialResult& t = results.trials[i];
    const json& shown = d["trials"][i];
    EXPECT_EQ(shown["contestant"], t.contestant);
    EXPECT_EQ(shown["cave"], t.cave);
    EXPECT_EQ(shown["seed"], t.seed);
    EXPECT_EQ(shown["outcome"], t.outcome);
    ASSERT_EQ(shown["figures"].size(), evaluation::metric_definitions().size());
    for (std::size_t m = 0; m < t.figures.size(); ++m) expect_near(shown["figures"][m], t.figures[m]);
  }
}

TEST(CampaignReport, CurvesPassThroughTheTrialsSamples) {
  const CampaignResults results = fake_campaign(2, 2, 3);
  const json d = written(results);
  const auto& times = d["curves"]["t"];
  EXPECT_EQ(times.front(), 0);
  EXPECT_EQ(times.back(), 300);
  for (std::size_t i = 0; i < results.trials.size(); ++i)
    for (const CurvePoint& p : results.trials[i].curve)
      for (std::size_t k = 0; k < times.size(); ++k) {
        if (std::abs(times[k].get<double>() - p.time_s) > 1e-9) continue;
        EXPECT_NEAR(d["curves"]["coverage"]["trials"][i][k].get<double>(), p.coverage, 1e-3 * p.coverage);
        EXPECT_NEAR(d["curves"]["explored_m3"]["trials"][i][k].get<double>(), p.explored_m3,
                    1e-3 * p.explored_m3);
      }
}

TEST(CampaignReport, BandsAreMeansOverCavesWithIntervalsAround) {
  const CampaignResults results = fake_campaign(2, 3, 5);
  const json curves = written(results)["curves"]["coverage"];
  const std::size_t k = 60;
  double over_caves = 0;
  for (std::size_t cave = 0; cave < 3; ++cave) {
    double sum = 0;
    for (std::size_t i = 0; i < results.trials.size(); ++i)
      if (results.trials[i].contestant == 1 && results.trials[i].cave == cave)
        sum += curves["trials"][i][k].get<double>();
    const json& band = curves["bands"][1]["caves"][cave];
    EXPECT_EQ(band["n"], 5);
    EXPECT_NEAR(band["mean"][k].get<double>(), sum / 5, 2e-4);
    EXPECT_LT(band["low"][k], band["mean"][k]);
    EXPECT_GT(band["high"][k], band["mean"][k]);
    over_caves += sum / 15;
  }
  EXPECT_NEAR(curves["bands"][1]["all"]["mean"][k].get<double>(), over_caves, 2e-4);
}

// As it was: with few seeds the widened percentiles of coverages near 1 came out above it.
TEST(CampaignReport, NoIntervalOfAMeanLeavesWhatTheFigureCanBe) {
  CampaignResults results = fake_campaign(1, 2, 3);
  const double coverage[] = {0.7, 1, 0.995};
  for (std::size_t i = 0; i < results.trials.size(); ++i) {
    TrialResult& t = results.trials[i];
    figure(t, "coverage") = coverage[i % 3];
    figure(t, "path_length_m") = i % 3 == 0 ? 0.5 : 900;
    for (CurvePoint& p : t.curve) p.coverage = coverage[i % 3], p.explored_m3 = i % 3 == 0 ? 1 : 400;
  }
  const json page = written(results);
  for (const char* quantity : {"coverage", "explored_m3"})
    for (const json& band :
         {page["curves"][quantity]["bands"][0]["all"], page["curves"][quantity]["bands"][0]["caves"][0]})
      for (std::size_t k = 0; k < band["low"].size(); ++k) {
        EXPECT_GE(band["low"][k].get<double>(), 0);
        EXPECT_LE(band["low"][k], band["mean"][k]);
        EXPECT_GE(band["high"][k], band["mean"][k]);
        if (quantity == std::string("coverage")) {
          EXPECT_LE(band["high"][k].get<double>(), 1);
        }
      }
  const json& shares = page["summaries"][evaluation::metric_index("coverage")][0]["caves"][0]["interval"];
  EXPECT_EQ(shares[1], 1);  // it was cut
  const json& intervals =
      page["summaries"][evaluation::metric_index("path_length_m")][0]["caves"][0]["interval"];
  EXPECT_EQ(intervals[0], 0);
  EXPECT_GT(intervals[1].get<double>(), 900);  // a length has no most
}

TEST(CampaignReport, SaysWhereAnIntervalIsOverCavesForWantOfSeeds) {
  const json one = written(fake_campaign(1, 4, 1)), many = written(fake_campaign(1, 4, 3));
  const int metric = evaluation::metric_index("coverage");
  EXPECT_EQ(one["curves"]["coverage"]["bands"][0]["all"]["over"], "caves");
  EXPECT_EQ(one["summaries"][metric][0]["all"]["over"], "caves");
  EXPECT_TRUE(one["summaries"][metric][0]["caves"][0]["interval"][0].is_null());
  EXPECT_FALSE(many["curves"]["coverage"]["bands"][0]["all"].contains("over"));
  EXPECT_FALSE(many["summaries"][metric][0]["all"].contains("over"));
}

TEST(CampaignReport, OfATrialCutShortKeepsWhatItHadExploredToTheEnd) {
  CampaignResults results = fake_campaign(1, 1, 2);
  results.trials[0].curve.resize(10);
  const double last = results.trials[0].curve.back().explored_m3;
  const json d = written(results);
  EXPECT_NEAR(d["curves"]["explored_m3"]["trials"][0].back().get<double>(), last, 1e-3 * last);
}

// The curves ended at 38 s where the horizon was 60 s.
TEST(CampaignReport, CurvesGoOnToTheHorizonWhereAllFlightsEndBefore) {
  CampaignResults results = fake_campaign(1, 1, 2);
  for (TrialResult& t : results.trials) t.curve.resize(10);
  ASSERT_LT(results.trials[0].curve.back().time_s, results.horizon_s);
  const json curves = written(results)["curves"];
  EXPECT_EQ(curves["t"].back(), results.horizon_s);
  const double last = results.trials[0].curve.back().coverage;
  EXPECT_NEAR(curves["coverage"]["trials"][0].back().get<double>(), last, 1e-3 * last);
  results.horizon_s = 0;  // not known
  EXPECT_NEAR(written(results)["curves"]["t"].back().get<double>(), results.trials[0].curve.back().time_s,
              1e-6);
}

TEST(CampaignReport, VerdictsAreThoseOfTheStatistics) {
  const CampaignResults results = fake_campaign(3, 2, 6);
  const Verdicts verdicts = compare_all(results);
  const json d = written(results);
  EXPECT_EQ(d["verdicts"]["sentence"], verdicts.sentence);
  ASSERT_EQ(d["verdicts"]["comparisons"].size(), verdicts.comparisons.size());
  for (std::size_t i = 0; i < verdicts.comparisons.size(); ++i) {
    const Comparison& c = verdicts.comparisons[i];
    const json& shown = d["verdicts"]["comparisons"][i];
    EXPECT_EQ(shown["sentence"], c.sentence);
    expect_near(shown["difference"], c.difference);
    expect_near(shown["interval"][0], c.interval.low);
    expect_near(shown["p"], c.p_corrected);
  }
  for (std::size_t i = 0; i < verdicts.ranking.size(); ++i)
    EXPECT_EQ(d["verdicts"]["ranking"][i]["contestant"], verdicts.ranking[i].contestant);
}

TEST(CampaignReport, CountsAFailedTrialAsStatisticsDo) {
  CampaignResults results = fake_campaign(2, 2, 3);
  TrialResult& t = results.trials[2];
  t.failed = true, t.outcome = "", t.reason = "killed by signal 11", t.curve.clear();
  t.figures.assign(t.figures.size(), kUnknown);
  const json d = written(results);
  const int coverage = evaluation::metric_index("coverage");
  EXPECT_TRUE(d["trials"][2]["figures"][coverage].is_null());
  expect_near(d["trials"][2]["counted"][coverage], figure_of(t, coverage, results.horizon_s));
  EXPECT_FALSE(d["trials"][0].contains("counted"));
  EXPECT_EQ(d["curves"]["coverage"]["trials"][2].back(), 0);
  EXPECT_EQ(d["worst"][0]["trial"], 2);
  EXPECT_EQ(d["worst"][0]["why"], "failed");
}

TEST(CampaignReport, WorstTrialsComeInTheOrderOfTheirTrouble) {
  CampaignResults results = fake_campaign(2, 1, 6, 0.0, 0.0);
  const int metric = evaluation::metric_index("coverage_auc");
  EXPECT_LE(worst_trials(results, metric, 100).size(), 2u);  // at most the slowest of each in the one cave
  results.trials[3].outcome = "stuck";
  results.trials[7].outcome = "contact";
  results.trials[9].failed = true;
  figure(results.trials[1], "coverage_auc") *= 0.2;
  const auto worst = worst_trials(results, metric, 4);
  ASSERT_EQ(worst.size(), 4u);
  for (const auto& [place, trial] : {std::pair{0u, 9u}, {1u, 7u}, {2u, 3u}, {3u, 1u}})
    EXPECT_EQ(worst[place].trial, trial);
  EXPECT_EQ(worst_trials(results, metric, 2).size(), 2u);
}

TEST(CampaignReport, ListsTrialsThatCameHomeEarlyWithHowTheyEnded) {
  CampaignResults results = fake_campaign(2, 1, 6, 0.0, 0.0);
  const int metric = evaluation::metric_index("coverage_auc");
  results.trials[2].outcome = "stuck";
  results.trials[2].ended = "on the ground 9 m from the start: the battery was nearly empty";
  results.trials[4].ended = "home after 4 s: the pose was lost; 98 % battery left";
  figure(results.trials[4], "completed") = 0;
  figure(results.trials[8], "completed") = 0;  // of a store of an earlier karst: without its ending
  results.trials[10].ended = "home because nothing was left to explore; 62 % battery left";
  figure(results.trials[10], "completed") = 1;
  const auto worst = worst_trials(results, metric, 3);
  ASSERT_EQ(worst.size(), 3u);
  EXPECT_EQ(worst[0].why, "did not land (stuck): " + results.trials[2].ended);
  std::set<std::pair<std::size_t, std::string>> early;  // of the same figure, in either order
  for (const std::size_t i : {1u, 2u}) early.emplace(worst[i].trial, worst[i].why);
  EXPECT_EQ(early,
            (std::set<std::pair<std::size_t, std::string>>{
                {4, "did not go as planned: " + results.trials[4].ended}, {8, "did not go as planned"}}));
  EXPECT_EQ(written(results)["trials"][4]["ended"], results.trials[4].ended);
}

TEST(CampaignReport, IsNotBrokenByHostileNames) {
  const std::string hostile = "</script><script>alert(1)</script><!-- \xff\" ' @scripts@ ${x}";
  CampaignResults results = fake_campaign(2, 1, 2);
  results.name = results.contestants[0].name = results.caves[0].name = hostile;
  results.contestants[0].parameters = results.contestants[1].settings = "not JSON " + hostile;
  results.trials[0].reason = results.trials[0].outcome = hostile;
  TemporaryDirectory dir;
  write_campaign_report(dir.path() / "report.html", results);
  const std::string page = bytes_of(dir.path() / "report.html");
  EXPECT_EQ(page.find("alert(1)</script>"), std::string::npos);
  const std::string shown = data_of(page)["contestants"][0]["name"];
  EXPECT_EQ(shown.substr(0, 9), "</script>");
}

TEST(CampaignReport, LinksAreRelativeAndEncoded) {
  EXPECT_EQ(relative_url("/data/campaign/runs/a-1", "/data/campaign"), "./runs/a-1");
  EXPECT_EQ(relative_url("/data/runs/", "/data/campaign/"), "./../runs");
  EXPECT_EQ(relative_url("/data/javascript:alert(1)//x", "/data"), "./javascript%3Aalert%281%29/x");
  EXPECT_EQ(relative_url("/data/a b\"#?%", "/data"), "./a%20b%22%23%3F%25");
}

TEST(CampaignReport, OfNextToNothingIsStillAPage) {
  for (const auto& [contestants, caves, seeds] :
       {std::tuple{0, 0, 0}, {1, 0, 0}, {2, 2, 0}, {1, 1, 1}, {1, 2, 3}, {2, 1, 1}}) {
    const CampaignResults results = fake_campaign(contestants, caves, seeds);
    const json d = written(results);
    EXPECT_EQ(d["trials"].size(), results.trials.size());
    EXPECT_EQ(d["curves"].is_null(), results.trials.empty());
  }
  CampaignResults failed = fake_campaign(2, 2, 2);
  for (TrialResult& t : failed.trials) {
    t.failed = true, t.curve.clear();
    t.figures.assign(t.figures.size(), kUnknown);
  }
  EXPECT_EQ(written(failed)["worst"].size(), 8u);
}

/// Two contestants, one cave, `seeds` seeds, each with a run directory below `dir`.
CampaignResults flown_campaign(const fs::path& dir, std::int64_t seeds) {
  CampaignResults results = fake_campaign(2, 1, seeds);
  test::FakeRunOptions small;
  small.length_m = 24;
  small.map_resolution_m = 0.5;
  for (TrialResult& t : results.trials) {
    t.run_dir = (dir / "runs" / (std::to_string(t.contestant) + "-" + std::to_string(t.seed))).string();
    test::write_fake_run(t.run_dir, small);
  }
  return results;
}

TEST(CampaignReport, EmbedsTheMiddleAndTheWorstFlightsOfEachCave) {
  TemporaryDirectory dir;
  CampaignResults results = flown_campaign(dir.path(), 5);
  for (TrialResult& t : results.trials)
    figure(t, "coverage_auc") = 0.1 * static_cast<double>((t.seed * 2) % 5);
  const json d = campaign_report_data(results, dir.path());
  EXPECT_EQ(d["replays"]["seeds"][0], json({1, 5}));  // 0.2 is the middle of 0, 0.1 ... 0.4; seed 5 has 0
  ASSERT_EQ(d["replays"]["scenes"].size(), 4u);
  for (const json& scene : d["replays"]["scenes"]) {
    EXPECT_GT(scene["cloud"]["count"], 100);
    EXPECT_GT(scene["end_s"], 0);
    EXPECT_EQ(scene["cloud"]["cell_m"], 0.5);
  }
  EXPECT_EQ(d["trials"][0]["run"], "./runs/0-1");
  EXPECT_EQ(d["trials"][0]["path"], "runs/0-1");
}

TEST(CampaignReport, KeepsReplayedMapsWithinTheirBudgetAndOfOneGrain) {
  TemporaryDirectory dir;
  CampaignResults results = flown_campaign(dir.path(), 1);
  test::FakeRunOptions coarse;
  coarse.length_m = 24;
  coarse.map_resolution_m = 1;
  fs::remove_all(results.trials[1].run_dir);
  test::write_fake_run(results.trials[1].run_dir, coarse);
  const json d = campaign_report_data(results, dir.path(), {.verdict = {}, .replay_points = 3000});
  std::size_t points = 0;
  for (const json& scene : d["replays"]["scenes"]) points += scene["cloud"]["count"].get<std::size_t>();
  EXPECT_LE(points, 3000u);
  EXPECT_GT(points, 100u);
  EXPECT_EQ(d["replays"]["scenes"][0]["cloud"]["cell_m"], d["replays"]["scenes"][1]["cloud"]["cell_m"]);
  EXPECT_TRUE(
      campaign_report_data(results, dir.path(), {.verdict = {}, .replay_points = 0})["replays"]["scenes"]
          .empty());
}

TEST(CampaignReport, OfRunsThatAreGoneOrDamagedGoesWithoutTheirReplay) {
  TemporaryDirectory dir;
  CampaignResults results = flown_campaign(dir.path(), 2);
  fs::remove_all(results.trials[0].run_dir);
  std::ofstream(fs::path(results.trials[2].run_dir) / "map_growth.bin") << "cut";
  std::ofstream(fs::path(results.trials[2].run_dir) / "trajectory.tum") << "nonsense";
  const json d = campaign_report_data(results, dir.path());
  EXPECT_TRUE(d["trials"][0]["run"].is_null());
  EXPECT_EQ(d["trials"].size(), 4u);
}

TEST(CampaignReport, WritesTheMissionReportsOfTheWorstWhenAsked) {
  TemporaryDirectory dir;
  CampaignResults results = flown_campaign(dir.path(), 2);
  results.trials[1].outcome = "contact";
  const fs::path report = fs::path(results.trials[1].run_dir) / "report.html";
  EXPECT_FALSE(
      campaign_report_data(results, dir.path(), {.verdict = {}, .worst = 1})["trials"][1]["reported"]);
  EXPECT_FALSE(fs::exists(report));
  const json d =
      campaign_report_data(results, dir.path(), {.verdict = {}, .worst = 1, .mission_reports = true});
  EXPECT_TRUE(d["trials"][1]["reported"]);
  EXPECT_TRUE(fs::exists(report));
}

TEST(CampaignReport, OneTrialThatCannotBeReadCostsNoOtherItsMissionReport) {
  TemporaryDirectory dir;
  CampaignResults results = flown_campaign(dir.path(), 2);
  for (const std::size_t trial : {0, 1}) results.trials[trial].outcome = "contact";
  const fs::path bad = results.trials[0].run_dir, good = results.trials[1].run_dir;
  fs::create_symlink("team.jsonl", bad / "team.jsonl");  // a loop: no InputError, but one of the file system
  const json d =
      campaign_report_data(results, dir.path(), {.verdict = {}, .worst = 4, .mission_reports = true});
  EXPECT_FALSE(fs::exists(bad / "report.html"));
  EXPECT_TRUE(fs::exists(good / "report.html"));
  EXPECT_NE(d["notes"].dump().find("no mission report"), std::string::npos);
}

TEST(CampaignReport, IsOneFileThatLoadsNothingAndComesOutTheSame) {
  TemporaryDirectory dir;
  const CampaignResults results = flown_campaign(dir.path(), 2);
  write_campaign_report(dir.path() / "one.html", results);
  write_campaign_report(dir.path() / "two.html", results);
  const std::string page = bytes_of(dir.path() / "one.html");
  EXPECT_EQ(page, bytes_of(dir.path() / "two.html"));
  const std::string markup = std::regex_replace(page.substr(0, page.find("<style>")), std::regex("\n"), " ");
  EXPECT_FALSE(std::regex_search(markup, std::regex("(src|href)=\"(?!data:)")));
  EXPECT_EQ(page.find("<script src"), std::string::npos);
  EXPECT_EQ(page.find("@import"), std::string::npos);
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
}

TEST(CampaignReport, ThatCannotBeWrittenSaysSo) {
  EXPECT_THROW(write_campaign_report("/nonexistent/folder/report.html", fake_campaign(1, 1, 1)),
               core::InputError);
}

}  // namespace
}  // namespace karst::campaign
